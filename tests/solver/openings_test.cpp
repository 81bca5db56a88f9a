// SPDX-License-Identifier: GPL-3.0-or-later
// What lets light in beside clear panes: openings that a study states, opal glass; and the ground in a
// building's shade.
#include <glm/trigonometric.hpp>

#include <numbers>

#include <solver/formfactor.hpp>
#include <solver/glass.hpp>

#include "solved.hpp"

namespace clerestory {
namespace {

using namespace drawn;

const glm::dvec3 sensor(2, 3, 0.85), up(0, 0, 1);
const Outline skylight = {{1, 1, 3}, {3, 1, 3}, {3, 3, 3}, {1, 3, 3}};

/// A black room of 4 x 6 x 3 m with a hole of 2 x 2 m in its roof.
Drawing roomWithSkylight(std::optional<std::uint32_t> pane) {
  Drawing drawing;
  drawing.scene.materials[plaster].reflectance = glm::dvec3(0.0);
  addBox(drawing, {0, 0, 0}, {4, 6, 3}, plaster, 0, {1});
  drawing.face({{0, 0, 3}, {4, 0, 3}, {4, 1, 3}, {0, 1, 3}});
  drawing.face({{0, 3, 3}, {4, 3, 3}, {4, 6, 3}, {0, 6, 3}});
  drawing.face({{0, 1, 3}, {1, 1, 3}, {1, 3, 3}, {0, 3, 3}});
  drawing.face({{3, 1, 3}, {4, 1, 3}, {4, 3, 3}, {3, 3, 3}});
  if (pane) drawing.face(skylight, *pane);
  return drawing;
}

Study evenSky() {
  Study study;
  study.sky.cieType = 5;
  study.grids = {gridOf({sensor})};
  return study;
}

// Under an even sky a hole shows its luminance, so a sensor reads the sky's illuminance times the form
// factor. Dirt and undrawn frames are the glass's matter, not the opening's.
TEST(Opening, LetsAllLightThrough) {
  Study study = evenSky();
  study.openings = {{skylight.begin(), skylight.end()}};
  study.dirtFactor = 0.5;
  Scene scene = roomWithSkylight(std::nullopt).scene;
  addSurroundings(study, scene);
  const Solved room = solved(scene, study);
  ASSERT_EQ(room.building.portals.size(), 1U);
  const double expected_lx = 10000.0 * pointToPolygon(sensor, up, skylight);
  EXPECT_NEAR(room.sensors_lx().at(0), expected_lx, 1e-3 * expected_lx);
}

Solved underOpal(const Study& study, double transmittance) {
  Drawing drawing = roomWithSkylight(glass);
  drawing.scene.materials[glass].transmittance = glm::dvec3(transmittance);
  drawing.scene.materials[glass].diffusing = true;
  return solved(drawing.scene, study);
}

// Opal glass is a lamp: what passes of an even sky is the hemispherical transmittance, sent out evenly. 4,096
// directions find it to 0.5 %.
TEST(OpalGlass, ScattersTheSkyEvenly) {
  const double expected_lx =
      10000.0 * Glass(0.5).hemisphericalTransmittance() * pointToPolygon(sensor, up, skylight);
  EXPECT_NEAR(underOpal(evenSky(), 0.5).sensors_lx().at(0), expected_lx, 0.005 * expected_lx);
}

// Under the sun it makes no patch: the pane's whole beam is spread.
TEST(OpalGlass, ScattersTheSun) {
  Study study = evenSky();
  study.sky.directNormal_lx = 50000.0;
  study.sky.sun_deg = glm::dvec2(60.0, 180.0);
  const double sine = std::sin(glm::radians(60.0));
  const double expected_lx =
      50000.0 * sine * Glass(0.5).transmittance(sine) * pointToPolygon(sensor, up, skylight);
  const SensorValue value = underOpal(study, 0.5).solution.grids.at(0).sensors.at(0);
  EXPECT_NEAR(value.sun_lx, expected_lx, 1e-3 * expected_lx);
}

// A ceiling sensor sees the ground alone. Before a facade of height h without end the ground at a distance d
// has lost the sky behind it, half of 1 - d / sqrt(d² + h²). The facade is 60 m high and 400 m long, black,
// and the ground 2 cm below the floor.
TEST(Ground, LiesInTheBuildingsShade) {
  constexpr double height_m = 60.0;
  const glm::dvec3 place(2, 2.5, 2.9);
  Study study;
  study.sky.cieType = 5;
  study.groundReflectance = 0.3;
  study.accuracy = 0.02;
  GridSettings grid = gridOf({place});
  grid.points[0] = {place.x, place.y, place.z, 0.0, 0.0, -1.0};
  study.grids = {grid};
  const auto read_lx = [&](bool isShaded) {
    Drawing drawing;
    drawing.scene.materials[plaster].reflectance = glm::dvec3(0.0);
    drawing.scene.materials[glass].transmittance = glm::dvec3(1.0);
    addRoomWithPane(drawing, {0, 0, 0}, {4, 6, 3}, {1, 1, 3, 2});
    drawing.face(upright(-200, 0, 0, height_m, 0));
    drawing.face(upright(4, 0, 204, height_m, 0));
    drawing.face(upright(0, 3, 4, height_m, 0));
    study.groundIsShaded = isShaded;
    addSurroundings(study, drawing.scene);
    return solved(drawing.scene, study).sensors_lx().at(0);
  };
  double shaded_lx = 0.0;
  double uniform_lx = 0.0;
  constexpr int cells = 200;
  const double luminance = 0.3 * 10000.0 / std::numbers::pi;
  for (int i = 0; i < cells; ++i) {
    for (int k = 0; k < cells; ++k) {
      const glm::dvec3 way =
          glm::dvec3(1.0 + 2.0 * (i + 0.5) / cells, 0.0, 1.0 + 1.0 * (k + 0.5) / cells) - place;
      const double square = glm::dot(way, way);
      const double share = way.z * way.y / (square * square) * 2.0 / (cells * cells);
      const double away_m = -way.y * (place.z + 0.02) / -way.z - place.y;
      const double lost = 0.5 * (1.0 - away_m / std::hypot(away_m, height_m));
      uniform_lx += luminance * share;
      shaded_lx += luminance * share * (1.0 - lost);
    }
  }
  const double uniformRead_lx = read_lx(false), shadedRead_lx = read_lx(true);
  std::cout << "uniform " << uniformRead_lx << " of " << uniform_lx << " lx, shaded " << shadedRead_lx
            << " of " << shaded_lx << " lx\n";
  EXPECT_LT(shaded_lx, 0.6 * uniform_lx);
  EXPECT_NEAR(uniformRead_lx, uniform_lx, 0.005 * uniform_lx);
  EXPECT_NEAR(shadedRead_lx, shaded_lx, 0.02 * shaded_lx);
}

/// A black room with a pane, and a sill of 2 x 0.15 m outdoors at the pane's foot; what falls on the sill.
double sillIlluminance_lx(const Study& study) {
  Drawing drawing;
  drawing.scene.materials[plaster].reflectance = glm::dvec3(0.0);
  drawing.scene.materials[glass].transmittance = glm::dvec3(0.65);
  addRoomWithPane(drawing, {0, 0, 0}, {4, 6, 3}, {1, 1, 3, 2});
  const std::uint32_t sill = addObject(drawing, "sill");
  drawing.face({{1, -0.15, 1}, {3, -0.15, 1}, {3, 0, 1}, {1, 0, 1}}, plaster, sill);
  const Solved room = solved(drawing.scene, study);
  double most_lx = 0.0;  // of the rows of both its faces
  for (const SurfaceValue& row : room.solution.surfaces) {
    if (room.building.model.surfaces[row.surface].name.starts_with("sill"))
      most_lx = std::max(most_lx, row.illuminanceMean_lx);
  }
  return most_lx;
}

// A sill sees the pane beside it at grazing angles, and the sky in it: an eighth of its light. Followed here
// direction by direction; a ray to the building's left, right or above passes it.
TEST(Pane, MirrorsTheSkyOntoTheSill) {
  Study study;
  study.groundReflectance = 0.0;
  study.accuracy = 0.02;
  const Glass pane(0.65);
  const auto luminance = [](double sine) {
    return 10000.0 * 9.0 / (7.0 * std::numbers::pi) * (1.0 + 2.0 * sine) / 3.0;
  };
  double straight_lx = 0.0, mirrored_lx = 0.0;
  constexpr int rows = 60, columns = 240, places = 24;
  for (int i = 0; i < rows; ++i) {
    for (int j = 0; j < columns; ++j) {
      for (int k = 0; k < places; ++k) {
        const double high = std::sqrt((i + 0.5) / rows), flat = std::sqrt(1.0 - high * high);
        const double azimuth = 2.0 * std::numbers::pi * (j + 0.5) / columns;
        const glm::dvec3 way(flat * std::sin(azimuth), flat * std::cos(azimuth), high);
        const glm::dvec3 from(1.0 + 2.0 * (k * 0.618034 - std::floor(k * 0.618034)),
                              -0.15 * (k + 0.5) / places, 1.0);
        const double share = std::numbers::pi / (rows * columns * places) * luminance(high);
        if (way.y <= 0.0) {
          straight_lx += share;
          continue;
        }
        const glm::dvec3 met = from - from.y / way.y * way;
        if (met.x < 0.0 || met.x > 4.0 || met.z > 3.0) {
          straight_lx += share;
        } else if (met.x > 1.0 && met.x < 3.0 && met.z < 2.0) {
          mirrored_lx += share * pane.reflectance(way.y);
        }
      }
    }
  }
  const double read_lx = sillIlluminance_lx(study);
  std::cout << "the sill has " << read_lx << " of " << straight_lx << " + " << mirrored_lx << " lx\n";
  EXPECT_GT(mirrored_lx, 0.1 * straight_lx);
  EXPECT_NEAR(read_lx, straight_lx + mirrored_lx, 0.01 * straight_lx);
}

// The sun at 45 deg before the pane: its image throws the share that glass mirrors at that angle onto all of
// the sill.
TEST(Pane, MirrorsTheSunOntoTheSill) {
  Study study;
  study.groundReflectance = 0.0;
  study.sky.diffuseHorizontal_lx = 1.0;
  study.sky.directNormal_lx = 60000.0;
  study.sky.sun_deg = glm::dvec2(45.0, 180.0);
  const double cosine = std::sqrt(0.5);
  const double expected_lx = 60000.0 * cosine * (1.0 + Glass(0.65).reflectance(cosine));
  EXPECT_NEAR(sillIlluminance_lx(study), expected_lx, 1.0 + 1e-3 * expected_lx);
}

}  // namespace
}  // namespace clerestory
