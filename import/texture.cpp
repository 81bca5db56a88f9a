// SPDX-License-Identifier: GPL-3.0-or-later
// Averages pictures over the parts of them that surfaces wear.
#include "texture.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace clerestory {
namespace {

constexpr std::size_t kFinest = 256;             // steps along a triangle's side
constexpr double kFewest = 32.0;                 // where texels are large
constexpr std::size_t kCoarse = 4;               // once the samples are used up
constexpr std::size_t kMaxSamples = 20'000'000;  // of one texture, a quarter of a second
constexpr double kManyTiles = 4.0;               // from here on the whole picture's mean is the triangle's
constexpr double kMaxCoordinate = 1e9;

std::size_t texelAt(double coordinate, std::size_t size, TextureWrap wrap) {
  double unit = coordinate;
  if (wrap == TextureWrap::clamp) {
    unit = std::clamp(unit, 0.0, 1.0);
  } else if (wrap == TextureWrap::repeat) {
    unit -= std::floor(unit);
  } else {
    unit = std::abs(unit - 2.0 * std::round(0.5 * unit));
  }
  return std::min(static_cast<std::size_t>(unit * static_cast<double>(size)), size - 1);
}

glm::dvec4 weighted(const glm::vec4& texel, bool byAlpha) {
  const double weight = byAlpha ? static_cast<double>(texel.w) : 1.0;
  return {weight * glm::dvec3(texel.x, texel.y, texel.z), weight};
}

bool isFinite(const glm::dvec2& uv) {
  return std::abs(uv.x) < kMaxCoordinate && std::abs(uv.y) < kMaxCoordinate;
}

}  // namespace

TextureMean::TextureMean(std::shared_ptr<const Picture> picture, const TextureMapping& mapping)
    : picture_(std::move(picture)), mapping_(mapping), samplesLeft_(kMaxSamples) {
  for (const glm::vec4& texel : picture_->texels) {
    whole_ += weighted(texel, mapping_.weighsByAlpha);
  }
  whole_ /= static_cast<double>(picture_->texels.size());
}

void TextureMean::add(double area, const std::array<glm::dvec2, 3>& corners) {
  std::array<glm::dvec2, 3> uv;
  for (std::size_t i = 0; i < 3; ++i) {
    uv[i] = mapping_.transform * glm::dvec3(corners[i], 1.0);
    if (!isFinite(uv[i])) {
      return;
    }
  }
  sum_ += area * meanOver(uv);
}

glm::dvec3 TextureMean::color() const {
  const glm::dvec4 sum = sum_.w > 0.0 ? sum_ : whole_.w > 0.0 ? whole_ : glm::dvec4(0.0, 0.0, 0.0, 1.0);
  return glm::dvec3(sum) / sum.w;
}

glm::dvec4 TextureMean::sample(const glm::dvec2& uv) const {
  const std::size_t x = texelAt(uv.x, picture_->width, mapping_.wrapU);
  const std::size_t y = texelAt(uv.y, picture_->height, mapping_.wrapV);
  return weighted(picture_->at(x, y), mapping_.weighsByAlpha);
}

/// Steps along each side that make parts of about a texel; 0: take the whole picture.
std::size_t TextureMean::stepsFor(const std::array<glm::dvec2, 3>& uv) {
  const glm::dvec2 a = uv[1] - uv[0];
  const glm::dvec2 b = uv[2] - uv[0];
  const double tiles = 0.5 * std::abs(a.x * b.y - a.y * b.x);
  if (tiles > kManyTiles && mapping_.wrapU != TextureWrap::clamp && mapping_.wrapV != TextureWrap::clamp) {
    return 0;
  }
  const glm::dvec2 size(picture_->width, picture_->height);
  double longest = 0.0;  // in texels
  for (const glm::dvec2& side : {a, b, b - a}) {
    const glm::dvec2 texels = side * size;
    longest = std::max(longest, std::hypot(texels.x, texels.y));
  }
  const double most = static_cast<double>(samplesLeft_ > 0 ? kFinest : kCoarse);
  const auto steps = static_cast<std::size_t>(std::clamp(std::ceil(longest), std::min(kFewest, most), most));
  samplesLeft_ -= std::min(samplesLeft_, steps * steps);
  return steps;
}

/// The triangle in steps² like parts, each by its middle.
glm::dvec4 TextureMean::meanOver(const std::array<glm::dvec2, 3>& uv) {
  const std::size_t steps = stepsFor(uv);
  if (steps == 0) {
    return whole_;
  }
  const auto n = static_cast<double>(steps);
  const glm::dvec2 a = (uv[1] - uv[0]) / n;
  const glm::dvec2 b = (uv[2] - uv[0]) / n;
  glm::dvec4 sum(0.0);
  for (std::size_t i = 0; i < steps; ++i) {
    for (std::size_t j = 0; i + j < steps; ++j) {
      const glm::dvec2 corner = uv[0] + static_cast<double>(i) * a + static_cast<double>(j) * b;
      sum += sample(corner + (a + b) / 3.0);
      if (i + j + 1 < steps) {  // the part that stands on its head
        sum += sample(corner + (a + b) * (2.0 / 3.0));
      }
    }
  }
  return sum / (n * n);
}

}  // namespace clerestory
