// SPDX-License-Identifier: GPL-3.0-or-later
// Form factors as links and elements make them: light from one surface to another in black rooms, against
// the exact ones.
#include <map>

#include <solver/formfactor.hpp>

#include "solved.hpp"

namespace clerestory {
namespace {

using namespace drawn;

struct Part {
  std::string name;
  Outline outline;
};

std::vector<Part> boxParts(const glm::dvec3& a, const glm::dvec3& b) {
  const std::vector<Outline> faces = box(a, b);
  return {{"floor", faces[0]}, {"ceiling", faces[1]}, {"south", faces[2]},
          {"east", faces[3]},  {"north", faces[4]},   {"west", faces[5]}};
}

/// Lumens that each part receives while both sides of one send 1 lm/m2 and all else is black: its exchange
/// area with the sender. [m2]
std::map<std::string, double> exchanged_m2(const std::vector<Part>& parts, const std::string& sender,
                                           const glm::dvec3& inside) {
  Drawing drawing;
  drawing.scene.materials[plaster].reflectance = glm::dvec3(0.0);
  const std::uint32_t lit = addMaterial(
      drawing, {.name = "lit", .reflectance = glm::dvec3(0.0), .exitance_lm_m2 = glm::dvec3(1.0)});
  for (const Part& part : parts)
    drawing.face(part.outline, part.name == sender ? lit : plaster, addObject(drawing, part.name));
  Study study;
  study.grids = {gridOf({inside})};  // the air that holds a sensor is solved, a room or not
  const Solved room = solved(drawing.scene, study);
  std::map<std::string, double> result;
  for (const SurfaceValue& row : room.solution.surfaces)
    result[room.building.model.surfaces[row.surface].name] += row.area_m2 * row.illuminanceMean_lx;
  return result;
}

double areaOf(const Outline& outline) {
  glm::dvec3 sum(0.0);
  for (std::size_t i = 2; i < outline.size(); ++i)
    sum += glm::cross(outline[i - 1] - outline[0], outline[i] - outline[0]);
  return 0.5 * glm::length(sum);
}

/// The same of two polygons with nothing between them, exactly: both sides of the first see both of the
/// other.
double exactly_m2(const Outline& receiver, const Outline& sender) {
  const Outline back(receiver.rbegin(), receiver.rend());
  const double tolerance = 1e-6 / std::max(areaOf(receiver), 1.0);
  return areaOf(receiver) *
         (polygonToPolygon(receiver, sender, tolerance) + polygonToPolygon(back, sender, tolerance));
}

// Faces that touch along their edges, at right angles: nothing is hidden, links are exact, and what is left
// is the quadrature over elements beside the edges.
TEST(Elements, FacesOfABox) {
  const std::vector<Part> parts = boxParts({0, 0, 0}, {4, 3, 2.5});
  std::map<std::string, double> gathered_m2;
  for (const Part& sender : parts) {
    const std::map<std::string, double> received_m2 = exchanged_m2(parts, sender.name, {1, 1, 1});
    for (const Part& receiver : parts) {
      gathered_m2[receiver.name] += received_m2.at(receiver.name);
      if (&receiver == &sender) continue;
      const double exact_m2 = exactly_m2(receiver.outline, sender.outline);
      EXPECT_NEAR(received_m2.at(receiver.name), exact_m2, 1e-3 * exact_m2)
          << sender.name << " to " << receiver.name;
    }
  }
  // Closure: each face has been seen by all others in turn and got all of what it can.
  for (const Part& part : parts)
    EXPECT_NEAR(gathered_m2.at(part.name), areaOf(part.outline), 1e-3 * areaOf(part.outline)) << part.name;
}

// Three equal faces at 70.5 degrees share a fourth's light.
TEST(Elements, FacesOfATetrahedron) {
  const glm::dvec3 a(4, 4, 4), b(4, 0, 0), c(0, 4, 0), d(0, 0, 4);
  const std::vector<Part> parts = {
      {"abc", {a, b, c}}, {"abd", {a, b, d}}, {"acd", {a, c, d}}, {"bcd", {b, c, d}}};
  for (const Part& sender : parts) {
    const auto received_m2 = exchanged_m2(parts, sender.name, {2, 2, 2});
    for (const Part& receiver : parts) {
      if (&receiver == &sender) continue;
      const double exact_m2 = areaOf(sender.outline) / 3.0;
      EXPECT_NEAR(received_m2.at(receiver.name), exact_m2, 1e-3 * exact_m2)
          << sender.name << " to " << receiver.name;
    }
  }
}

// A plate in the air of a box. It hides parts of the box from each other, but none from itself.
std::vector<Part> around(const Part& plate) {
  std::vector<Part> parts = boxParts({0, 0, 0}, {6, 5, 3});
  parts.push_back(plate);
  return parts;
}

class Plate : public testing::TestWithParam<Part> {};

// As a sender it is seen whole by every element. Only few points of an element that reaches below the plate's
// own horizon can see it, which costs a wall some tenths of a per cent.
TEST_P(Plate, SendsToAllFaces) {
  const Part& plate = GetParam();
  const std::vector<Part> parts = around(plate);
  const std::map<std::string, double> received_m2 = exchanged_m2(parts, plate.name, {0.5, 0.5, 0.5});
  for (const Part& face : parts) {
    if (face.name == plate.name) continue;
    const double exact_m2 = exactly_m2(plate.outline, face.outline);
    std::cout << face.name << ": " << 100.0 * (received_m2.at(face.name) / exact_m2 - 1.0) << " % off\n";
    EXPECT_NEAR(received_m2.at(face.name), exact_m2, 0.005 * exact_m2) << face.name;
  }
}

// Reciprocity: the plate receives what it sent. While a face sends, the plate's shadow is sampled and power
// is scaled for all alike, so a small receiver has the accuracy asked, 5 %, and no more.
TEST_P(Plate, ReceivesWhatItSent) {
  const Part& plate = GetParam();
  const std::vector<Part> parts = around(plate);
  const std::map<std::string, double> sent_m2 = exchanged_m2(parts, plate.name, {0.5, 0.5, 0.5});
  for (const Part& face : parts) {
    if (face.name == plate.name) continue;
    const double back_m2 = exchanged_m2(parts, face.name, {0.5, 0.5, 0.5}).at(plate.name);
    std::cout << face.name << ": " << 100.0 * (back_m2 / sent_m2.at(face.name) - 1.0) << " % off\n";
    EXPECT_NEAR(back_m2, sent_m2.at(face.name), 0.05 * sent_m2.at(face.name)) << face.name;
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, Plate,
    testing::Values(Part{"level", {{2, 2, 1}, {4, 2, 1}, {4, 3, 1}, {2, 3, 1}}},
                    Part{"upright", {{2, 2, 1}, {4, 2, 1}, {4, 2, 2}, {2, 2, 2}}},
                    Part{"leaning", {{2, 2, 1}, {4, 2, 1}, {4, 2.6, 1.8}, {2, 2.6, 1.8}}},
                    Part{"turned", {{2, 2, 1}, {3.6, 3.2, 1}, {3.24, 3.68, 1.8}, {1.64, 2.48, 1.8}}}),
    [](const auto& info) { return info.param.name; });

// Two centimetres in twenty metres. A wall that gets a hundredth of its light is held to the accuracy asked,
// 5 %.
TEST(Elements, TinyPlateSendsToHugeFaces) {
  const Part tiny{"tiny", {{7, 9, 1}, {7.02, 9, 1}, {7.02, 9.02, 1}, {7, 9.02, 1}}};
  std::vector<Part> parts = boxParts({0, 0, 0}, {20, 20, 3});
  parts.push_back(tiny);
  const std::map<std::string, double> received_m2 = exchanged_m2(parts, tiny.name, {0.5, 0.5, 0.5});
  for (const Part& face : parts) {
    if (face.name == tiny.name) continue;
    const double exact_m2 = exactly_m2(tiny.outline, face.outline);
    std::cout << face.name << ": " << 100.0 * (received_m2.at(face.name) / exact_m2 - 1.0) << " % off\n";
    EXPECT_NEAR(received_m2.at(face.name), exact_m2, 0.05 * exact_m2) << face.name;
  }
}

}  // namespace
}  // namespace clerestory
