// SPDX-License-Identifier: GPL-3.0-or-later
// What `clerestory inspect` prints of two rooms under a hollow ceiling, read as its user reads it.
#include "program.hpp"

namespace clerestory {
namespace {

/// Rectangles of a model, each an object of its own.
class Model {
 public:
  explicit Model(double scale) : scale_(scale) {}

  using Point = std::array<double, 3>;
  void face(const std::string& material, const std::array<Point, 4>& corners) {
    text_ += "o face " + std::to_string(++count_) + "\nusemtl " + material + "\n";
    for (const Point& corner : corners) {
      text_ += "v";
      for (const double value : corner) text_ += " " + std::to_string(scale_ * value);
      text_ += "\n";
    }
    text_ += "f -4 -3 -2 -1\n";
  }
  /// A rectangle at a height, or across y or x.
  void level(const std::string& material, double x0, double y0, double x1, double y1, double z) {
    face(material, {{{x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z}}});
  }
  void acrossY(const std::string& material, double y, double x0, double z0, double x1, double z1) {
    face(material, {{{x0, y, z0}, {x1, y, z0}, {x1, y, z1}, {x0, y, z1}}});
  }
  void acrossX(const std::string& material, double x, double y0, double z0, double y1, double z1) {
    face(material, {{{x, y0, z0}, {x, y1, z0}, {x, y1, z1}, {x, y0, z1}}});
  }
  [[nodiscard]] std::string text() const { return "mtllib rooms.mtl\n" + text_; }

 private:
  double scale_;
  int count_ = 0;
  std::string text_;
};

/// Two rooms of 4 x 3 x 3 m with two doors between them, one lit through its south side, the other with a
/// sheet of glass of 1 m² standing in it; over the lamps of the first one's ceiling a hollow 0.4 m high,
/// along which both begin 2 mm west of the origin.
std::string twoRooms(double scale) {
  Model model(scale);
  const double west = -0.002;
  model.level("plaster", west, 0, 8, 3, 0);
  model.level("lamp", west, 0, 4, 3, 3);
  model.level("plaster", 4, 0, 8, 3, 3);
  model.level("plaster", west, 0, 8, 3, 3.4);
  model.acrossY("glass", 0, west, 0, 4, 3);
  model.acrossY("plaster", 0, 4, 0, 8, 3);
  model.acrossY("plaster", 0, west, 3, 8, 3.4);
  model.acrossY("plaster", 3, west, 0, 8, 3.4);
  model.acrossX("plaster", west, 0, 0, 3, 3.4);
  model.acrossX("plaster", 8, 0, 0, 3, 3.4);
  for (const auto& [y0, y1] : {std::pair{0.0, 0.3}, std::pair{1.2, 1.8}, std::pair{2.7, 3.0}})
    model.acrossX("plaster", 4, y0, 0, y1, 2.1);
  model.acrossX("plaster", 4, 0, 2.1, 3, 3);
  model.acrossY("glass", 1.5, 6, 0.5, 7, 1.5);
  return model.text();
}

std::size_t countOf(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

class Inspect : public testing::Test {
 protected:
  [[nodiscard]] std::string inspected(double scale) const {
    place_.write("rooms.obj", twoRooms(scale));
    place_.write("rooms.mtl",
                 "newmtl plaster\nKd 0.5 0.5 0.5\nnewmtl lamp\nKd 0.8 0.8 0.8\nKe 100 100 100\n"
                 "newmtl glass\nTf 0.7 0.7 0.7\nd 0.3\nillum 4\n");
    const std::string command = "cd '" + place_.path().string() +
                                "' && '" CLERESTORY_PROGRAM
                                "' inspect rooms.obj >output.txt 2>messages.txt </dev/null";
    EXPECT_EQ(std::system(command.c_str()), 0) << bytesOf(place_.path() / "messages.txt");
    return bytesOf(place_.path() / "output.txt");
  }
  Workplace place_;
};

// The lamps' backs light the hollow, which is no air of its own all the same.
TEST_F(Inspect, TellsRoomsWindowsAndHollows) {
  const std::string text = inspected(1.0);
  for (const char* line :
       {"8.00 x 3.00 x 3.40 m, from (0.00, 0.00, 0.00)", "Units: m (guessed", "Windows: 1 pane, 12.01 m2; ",
        "glazing that is no window (within the building, outdoors or covered): 1.00 m2", "Room 1, Room 2\n",
        "1 hollow without room or pane", "Nothing to warn of."})
    EXPECT_EQ(countOf(text, line), 1U) << line << " is not once in\n" << text;
  EXPECT_EQ(countOf(text, "closed, lit"), 1U) << text;
  // By two doors, but named once.
  EXPECT_EQ(countOf(text, "12.01  Room 2\n"), 1U) << text;
  EXPECT_EQ(countOf(text, "0.00  Room 1\n"), 1U) << text;
}

TEST_F(Inspect, TellsSizesAsPeopleWriteThem) {
  EXPECT_EQ(countOf(inspected(1000.0),
                    "C101 as metres the model would measure 8002 x 3000 x 3400 m, so it was read in mm"),
            1U);
}

}  // namespace
}  // namespace clerestory
