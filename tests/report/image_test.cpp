// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures read back: luminances from the EXR, sRGB codes from the PNG, and the plan's false colours.
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>

#include <import/error.hpp>

#include "fake.hpp"

namespace clerestory {
namespace {

namespace fs = std::filesystem;

struct Picture {
  OIIO::ImageSpec spec;
  std::vector<float> values;
};

Picture read(const fs::path& file) {
  const auto in = OIIO::ImageInput::open(file.string());
  EXPECT_TRUE(in) << OIIO::geterror();
  if (!in) return {};
  Picture picture{in->spec(), {}};
  picture.values.resize(static_cast<std::size_t>(picture.spec.image_pixels()) * 3);
  EXPECT_TRUE(in->read_image(0, 0, 0, 3, OIIO::TypeDesc::FLOAT, picture.values.data()));
  return picture;
}

double srgb(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}

/// A case whose one view is a ramp of greys from 0 to 0.25 in scene-linear values at a fixed exposure.
fake::Case ramp() {
  fake::Case made = fake::office();
  made.study.views[0].exposure_ev = 3.0;  // middle grey at 1 cd/m²
  LuminanceImage image;
  image.width = 500;
  image.height = 2;
  for (int i = 0; i < 1000; ++i)
    image.pixels_cd_m2.emplace_back(static_cast<float>(0.25 * i / 1000.0 / 0.18));
  made.solution.views = {image};
  return made;
}

TEST(Views, PngIsSrgbToOneCodeValueBelowTheShoulder) {
  const fake::TemporaryFolder folder;
  writeReport(folder.path() / "r", ramp().input());
  const Picture png = read(folder.path() / "r" / "view-entrance.png");
  ASSERT_EQ(png.spec.format, OIIO::TypeDesc::UINT8);
  ASSERT_EQ(png.values.size(), 3000u);
  for (std::size_t i = 0; i < png.values.size(); ++i) {
    const double expected = 255.0 * srgb(0.25 * static_cast<double>(i / 3) / 1000.0);
    ASSERT_NEAR(255.0 * static_cast<double>(png.values[i]), expected, 1.0) << i;
  }
}

TEST(Views, HighlightsRollOffWithoutReachingOver) {
  const fake::TemporaryFolder folder;
  fake::Case made = ramp();
  for (std::size_t i = 0; i < 1000; ++i) {
    made.solution.views[0].pixels_cd_m2[i] =
        glm::vec3(static_cast<float>(0.4 * std::pow(1.01, static_cast<double>(i))));
  }
  writeReport(folder.path() / "r", made.input());
  const Picture png = read(folder.path() / "r" / "view-entrance.png");
  for (std::size_t i = 3; i < png.values.size(); ++i) ASSERT_GE(png.values[i], png.values[i - 3]);
  EXPECT_EQ(png.values.back(), 1.0F);
  EXPECT_EQ(
      std::count_if(png.values.begin(), png.values.end(), [](float v) { return v > 0.9F && v < 1.0F; }) > 60,
      true);
}

TEST(Views, ExrTimesItsScaleIsLuminance) {
  const fake::TemporaryFolder folder;
  const fake::Case made = fake::office();
  writeReport(folder.path() / "r", made.input());
  const Picture exr = read(folder.path() / "r" / "view-entrance.exr");
  EXPECT_EQ(exr.spec.format, OIIO::TypeDesc::HALF);
  const double scale = static_cast<double>(exr.spec.get_float_attribute("clerestory:luminanceScale"));
  ASSERT_GT(scale, 0.0);
  EXPECT_EQ(exr.spec.get_string_attribute("DateTime"), "2000:01:01 00:00:00");
  for (std::size_t i = 0; i < exr.values.size(); ++i) {
    const double expected =
        static_cast<double>(made.solution.views[0].pixels_cd_m2[i / 3][static_cast<int>(i % 3)]);
    ASSERT_NEAR(static_cast<double>(exr.values[i]) * scale, expected, 1e-3 * expected);
  }
}

// What the viewer of an EXR sees with the config beside it is the PNG.
TEST(Views, PngIsWhatOpenColorIosToolMakesOfTheExr) {
  if (std::system("oiiotool --help >/dev/null 2>&1") != 0) GTEST_SKIP() << "oiiotool is not installed";
  const fake::TemporaryFolder folder;
  fake::Case made = ramp();
  for (std::size_t i = 0; i < 1000; ++i) {  // saturated and grey, from black to far beyond white
    const auto value = static_cast<float>(1e-3 * std::pow(1.015, static_cast<double>(i)));
    made.solution.views[0].pixels_cd_m2[i] = {value, i % 3 == 0 ? value : 0.3F * value, 0.7F * value};
  }
  writeReport(folder.path() / "r", made.input());
  const std::string place = "cd '" + (folder.path() / "r").string() + "' && oiiotool --colorconfig ";
  for (const std::string view : {"Filmic", "Plain"}) {
    const std::string command = place +
                                "config.ocio view-entrance.exr --ociodisplay:from=\"Linear Rec.709\" sRGB " +
                                view + " -d uint8 -o ../tool.png";
    ASSERT_EQ(std::system(command.c_str()), 0);
    const Picture own = read(folder.path() / "r" / "view-entrance.png");
    const Picture tool = read(folder.path() / "tool.png");
    ASSERT_EQ(own.values.size(), tool.values.size());
    int most = 0;
    for (std::size_t i = 0; i < own.values.size(); ++i)
      most = std::max(most, static_cast<int>(std::lround(255.0F * std::abs(own.values[i] - tool.values[i]))));
    if (view == "Filmic") {
      EXPECT_LE(most, 1);
    } else {
      EXPECT_GT(most, 10);  // another view is another picture
    }
  }
}

/// Sets an environment variable while it lives.
class Environment {
 public:
  Environment(const char* name, const std::string& value) : name_(name) { setenv(name, value.c_str(), 1); }
  ~Environment() { unsetenv(name_); }
  Environment(const Environment&) = delete;
  Environment& operator=(const Environment&) = delete;

 private:
  const char* name_;
};

TEST(Views, TheUsersOwnConfigIsUsed) {
  const fake::TemporaryFolder folder;
  const fs::path config = folder.path() / "own.ocio";
  std::ofstream(config) << "ocio_profile_version: 1\nroles: {default: lin_srgb}\n"
                           "displays: {wall: [!<View> {name: half, colorspace: half}]}\ncolorspaces:\n"
                           "  - !<ColorSpace> {name: lin_srgb}\n"
                           "  - !<ColorSpace> {name: half, from_reference: !<MatrixTransform> "
                           "{matrix: [0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 1]}}\n";
  const Environment own("OCIO", config.string());
  writeReport(folder.path() / "r", ramp().input());
  EXPECT_FALSE(fs::exists(folder.path() / "r" / "config.ocio"));
  const Picture png = read(folder.path() / "r" / "view-entrance.png");
  for (std::size_t i = 0; i < png.values.size(); ++i) {
    const double expected = 255.0 * 0.5 * 0.25 * static_cast<double>(i / 3) / 1000.0;
    ASSERT_NEAR(255.0 * static_cast<double>(png.values[i]), expected, 1.0) << i;
  }
}

TEST(Views, AConfigThatCannotBeUsedIsNamed) {
  const fake::TemporaryFolder folder;
  const fs::path config = folder.path() / "own.ocio";
  std::ofstream(config) << "ocio_profile_version: 1\nroles: {default: film}\n"
                           "displays: {wall: [!<View> {name: film, colorspace: film}]}\n"
                           "colorspaces:\n  - !<ColorSpace> {name: film}\n";
  for (const std::string& file : {std::string("/nowhere/config.ocio"), config.string()}) {
    const Environment own("OCIO", file);
    try {
      checkDisplay();
      ADD_FAILURE() << file;
    } catch (const InputError& error) {
      const std::string message = error.what();
      EXPECT_NE(message.find("OCIO"), std::string::npos) << message;
      EXPECT_NE(message.find(file), std::string::npos) << message;
      EXPECT_EQ(message.find("lin_rec709_scene") != std::string::npos, file == config.string()) << message;
    }
  }
}

TEST(Views, CameraExposureAndDepthAreInTheFiles) {
  const fake::TemporaryFolder folder;
  fake::Case made = ramp();
  made.study.views[0].eye_m = {1.5, 2.5, 1.625};
  made.study.views[0].exrBits = 32;
  made.study.views[0].pngBits = 16;
  writeReport(folder.path() / "r", made.input());
  const Picture exr = read(folder.path() / "r" / "view-entrance.exr");
  EXPECT_EQ(exr.spec.format, OIIO::TypeDesc::FLOAT);
  EXPECT_NEAR(exr.spec.get_float_attribute("clerestory:exposureEv"), 3.0F, 1e-5F);
  EXPECT_EQ(exr.spec.get_string_attribute("clerestory:projection"), "perspective");
  EXPECT_EQ(exr.spec.get_float_attribute("clerestory:fieldOfView_deg"), 70.0F);
  const OIIO::ParamValue* eye = exr.spec.find_attribute("clerestory:eye_m");
  ASSERT_NE(eye, nullptr);
  EXPECT_EQ(static_cast<const float*>(eye->data())[2], 1.625F);
  const Picture png = read(folder.path() / "r" / "view-entrance.png");
  EXPECT_EQ(png.spec.format, OIIO::TypeDesc::UINT16);
  for (std::size_t i = 0; i < png.values.size(); ++i) {
    const double expected = srgb(0.25 * static_cast<double>(i / 3) / 1000.0);
    ASSERT_NEAR(static_cast<double>(png.values[i]), expected, 2e-4) << i;
  }
}

TEST(Views, AutomaticExposurePutsTheLogarithmicMeanAtMiddleGrey) {
  const fake::TemporaryFolder folder;
  fake::Case made = fake::office();
  for (glm::vec3& pixel : made.solution.views[0].pixels_cd_m2) pixel *= 1000.0F;
  writeReport(folder.path() / "r", made.input());
  const Picture exr = read(folder.path() / "r" / "view-entrance.exr");
  double sum = 0.0;
  for (std::size_t i = 0; i < exr.values.size(); i += 3) {
    sum += std::log(0.2126 * static_cast<double>(exr.values[i]) +
                    0.7152 * static_cast<double>(exr.values[i + 1]) +
                    0.0722 * static_cast<double>(exr.values[i + 2]));
  }
  EXPECT_NEAR(std::exp(sum / (static_cast<double>(exr.values.size()) / 3.0)), 0.18, 0.001);
}

TEST(Views, BlackNegativeAndBrokenPixelsAreBlack) {
  const fake::TemporaryFolder folder;
  fake::Case made = fake::office();
  for (glm::vec3& pixel : made.solution.views[0].pixels_cd_m2) pixel = glm::vec3(0.0F, -4.0F, std::nanf(""));
  writeReport(folder.path() / "r", made.input());
  for (const char* file : {"view-entrance.exr", "view-entrance.png"}) {
    for (const float v : read(folder.path() / "r" / file).values) ASSERT_EQ(v, 0.0F) << file;
  }
}

TEST(Plans, BrighterSensorsAreLighter) {
  const fake::TemporaryFolder folder;
  fake::Case made = fake::office();
  made.building.rooms[0].floorPieces.clear();
  SensorGrid& grid = made.building.grids[0];
  grid.points = {{0, 0, 1}, {1, 0, 1}, {2, 0, 1}};
  grid.normals.resize(3);
  made.solution.grids[0].sensors.resize(3);
  for (std::size_t s = 0; s < 3; ++s)
    made.solution.grids[0].sensors[s].illuminance_lx = std::pow(10.0, static_cast<double>(s) + 1.0);
  writeReport(folder.path() / "r", made.input());
  const Picture plan = read(folder.path() / "r" / "plan-Desks.png");
  // The row through the middle of the squares, away from their numbers.
  const auto lightnessAt = [&](double metres) {
    const double scale = 200.0;  // 3.8 m wide with the margins: the largest scale of a plan
    const auto x = static_cast<std::size_t>((metres + 0.9) * scale);
    const auto y = static_cast<std::size_t>(0.55 * scale);
    const std::size_t at = 3 * (y * static_cast<std::size_t>(plan.spec.width) + x);
    return 0.2126F * plan.values.at(at) + 0.7152F * plan.values.at(at + 1) + 0.0722F * plan.values.at(at + 2);
  };
  EXPECT_GT(lightnessAt(1.0), lightnessAt(0.0) + 0.1F);
  EXPECT_GT(lightnessAt(2.0), lightnessAt(1.0) + 0.1F);
  EXPECT_LT(lightnessAt(2.0), 0.95F);
}

}  // namespace
}  // namespace clerestory
