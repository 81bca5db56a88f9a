// SPDX-License-Identifier: GPL-3.0-or-later
// What is sealed stays dark: under the brightest sky, beside the brightest room, with walls drawn as badly as
// they come.
#include "solved.hpp"

namespace clerestory {
namespace {

using namespace drawn;

const glm::dvec3 kHigh(4, 3, 3);

Study brightStudy() {
  Study study;
  study.sky.diffuseHorizontal_lx = 1e6;
  study.accuracy = 0.1;  // a leak would show at any accuracy
  GridSettings grid;
  grid.name = "all";
  grid.spacing_m = 0.25;
  study.grids = {grid};
  return study;
}

void addLamp(Drawing& drawing, const glm::dvec3& centre, double exitance_lm_m2) {
  const std::uint32_t lamp = addMaterial(
      drawing,
      {.name = "lamp", .reflectance = glm::dvec3(0.0), .exitance_lm_m2 = glm::dvec3(exitance_lm_m2)});
  const std::uint32_t object = addObject(drawing, "lamp");
  drawing.face({centre + glm::dvec3(-0.2, -0.2, 0), centre + glm::dvec3(0.2, -0.2, 0),
                centre + glm::dvec3(0.2, 0.2, 0), centre + glm::dvec3(-0.2, 0.2, 0)},
               lamp, object);
}

struct Sealing {
  const char* name;
  Drawing drawing;
};

// One sealed room, in each of the ways that walls are drawn.
std::vector<Sealing> sealedRooms() {
  std::vector<Sealing> rooms;
  {
    Drawing plain;
    addBox(plain, {0, 0, 0}, kHigh);
    rooms.push_back({"plain", plain});
    Drawing twice = plain;
    twice.face(upright(0, 0, 4, 3));
    rooms.push_back({"a wall drawn twice", twice});
    Drawing twoMaterials = plain;
    twoMaterials.face(upright(0, 0, 4, 3), wood, 1);
    rooms.push_back({"a wall drawn twice in two materials", twoMaterials});
    Drawing part = plain;
    part.face(upright(0.7, 0.4, 2.9, 2.2), wood, 1);
    rooms.push_back({"a board on a wall, in its plane", part});
  }
  {
    Drawing junctions;  // the south wall in pieces whose corners its neighbours do not have
    addBox(junctions, {0, 0, 0}, kHigh, plaster, 0, {2});
    junctions.face(upright(0, 0, 4, 0.7));
    junctions.face(upright(0, 0.7, 1.3, 2.1));
    junctions.face(upright(1.3, 0.7, 4, 1.9));
    junctions.face(upright(1.3, 1.9, 4, 2.1));
    junctions.face(upright(0, 2.1, 2.2, 3), wood, 1);
    junctions.face(upright(2.2, 2.1, 4, 3));
    rooms.push_back({"walls with T-junctions", junctions});
  }
  {
    Drawing fans;  // triangles, turned so that no edge is axis-parallel
    const double c = std::cos(0.3);
    const double s = std::sin(0.3);
    for (Outline face : box({0, 0, 0}, kHigh)) {
      for (glm::dvec3& p : face) p = {c * p.x - s * p.y, s * p.x + c * p.y, p.z};
      fans.fan(face, 1);
    }
    rooms.push_back({"triangles, turned", fans});
  }
  return rooms;
}

TEST(Sealed, DarkRoomStaysDark) {
  for (const Sealing& room : sealedRooms()) {
    SCOPED_TRACE(room.name);
    const Solved dark = solved(room.drawing.scene, brightStudy());
    ASSERT_EQ(dark.building.rooms.size(), 1U);
    EXPECT_TRUE(dark.building.domains[0].open);
    ASSERT_FALSE(dark.solution.grids[0].sensors.empty());
    for (const SensorValue& sensor : dark.solution.grids[0].sensors) EXPECT_EQ(sensor.illuminance_lx, 0.0);
    for (const SurfaceValue& row : dark.solution.surfaces) {
      if (row.room == 0) {
        EXPECT_EQ(row.illuminanceMax_lx, 0.0);
      }
    }
  }
}

// With a lamp the room is solved in all columns, so that every ray and link has its chance to leak.
TEST(Sealed, SkyDoesNotEnterALitRoom) {
  for (Sealing& room : sealedRooms()) {
    SCOPED_TRACE(room.name);
    addLamp(room.drawing, {1.6, 1.8, 2.5}, 1000.0);
    const Solved lit = solved(room.drawing.scene, brightStudy());
    ASSERT_EQ(lit.building.rooms.size(), 1U);
    EXPECT_EQ(lit.solution.columns, 2);
    for (const SensorValue& sensor : lit.solution.grids.at(0).sensors) {
      EXPECT_EQ(sensor.sky_lx, 0.0);
      EXPECT_GT(sensor.electric_lx, 0.0);
    }
    const EnergyBalance balance = lit.balanceOf(lit.building.rooms[0].domain);
    EXPECT_NEAR(balance.emitted_lm, 2 * 0.16 * 1000.0, 1e-3);  // both sides of the lamp; areas are float
    EXPECT_EQ(balance.escaped_lm, 0.0);
  }
}

// A lamp in the first room, a window in the second: each has its own light alone.
Drawing twoRooms(double apart_m) {
  Drawing drawing;
  addBox(drawing, {0, 0, 0}, kHigh, plaster, 1);  // an object of its own: their floors are two
  addRoomWithPane(drawing, {4 + apart_m, 0, 0}, {8 + apart_m, 3, 3},
                  {5.0 + apart_m, 1.0, 7.0 + apart_m, 2.0});
  addLamp(drawing, {1.6, 1.8, 2.5}, 1e5);
  return drawing;
}

TEST(Sealed, RoomsSideBySideExchangeNothing) {
  for (const double apart_m : {0.0, 0.1, 1.0}) {
    SCOPED_TRACE(apart_m);
    const Solved both = solved(twoRooms(apart_m).scene, brightStudy());
    ASSERT_EQ(both.building.rooms.size(), 2U);
    ASSERT_EQ(both.solution.grids.size(), 2U);
    for (const SensorValue& sensor : both.solution.grids[0].sensors) {
      EXPECT_EQ(sensor.sky_lx, 0.0);
      EXPECT_GT(sensor.electric_lx, 0.0);
    }
    for (const SensorValue& sensor : both.solution.grids[1].sensors) {
      EXPECT_EQ(sensor.electric_lx, 0.0);
      EXPECT_GT(sensor.sky_lx, 0.0);
    }
  }
}

TEST(Sealed, DarkRoomBesideALitOneStaysDark) {
  for (const double apart_m : {0.0, 0.1}) {
    SCOPED_TRACE(apart_m);
    Drawing drawing;
    addBox(drawing, {0, 0, 0}, kHigh, plaster, 1);
    addBox(drawing, {4 + apart_m, 0, 0}, {8 + apart_m, 3, 3});
    addLamp(drawing, {1.6, 1.8, 2.5}, 1e5);
    const Solved both = solved(drawing.scene, brightStudy());
    ASSERT_EQ(both.solution.grids.size(), 2U);
    for (const SensorValue& sensor : both.solution.grids[0].sensors) EXPECT_GT(sensor.illuminance_lx, 0.0);
    for (const SensorValue& sensor : both.solution.grids[1].sensors) EXPECT_EQ(sensor.illuminance_lx, 0.0);
  }
}

}  // namespace
}  // namespace clerestory
