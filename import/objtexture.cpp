// SPDX-License-Identifier: GPL-3.0-or-later
// Averages an OBJ's pictures over the faces that wear them.
#include "objtexture.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <numeric>
#include <span>

#include "textfile.hpp"

namespace clerestory {
namespace {

constexpr std::uintmax_t kMaxPictureBytes = 512ULL << 20U;

class ObjTextures {
 public:
  ObjTextures(const TextureCoordinates& coordinates, Scene& scene)
      : coordinates_(coordinates), scene_(scene) {}

  void apply(MtlMaterial& material, std::span<const std::uint32_t> faces) {
    DisplayMaterial& display = material.display;
    if (material.color) {
      if (const auto mean = meanOf(material, *material.color, faces)) {
        // Black is what some programs write where a picture gives the colour.
        const bool isUnstated = !display.color || *display.color == glm::dvec3(0.0);
        display.color = *mean * (isUnstated ? glm::dvec3(1.0) : *display.color);
      } else if (display.color == glm::dvec3(0.0)) {
        display.color.reset();
      }
    }
    if (material.luminance) {
      if (const auto mean = meanOf(material, *material.luminance, faces)) {
        display.luminance_cd_m2 *= *mean;
      }
    }
  }

 private:
  std::optional<glm::dvec3> meanOf(const MtlMaterial& material, const MtlTexture& texture,
                                   std::span<const std::uint32_t> faces) {
    const std::shared_ptr<const Picture> picture = pictureOf(material.folder, texture);
    if (!picture) {
      return std::nullopt;
    }
    TextureMean mean(picture, texture.mapping);
    for (const std::uint32_t face : faces) {
      addFace(face, mean);
    }
    return texture.base + texture.gain * mean.color();
  }

  /// As a fan of triangles; faces with a corner that has no `vt` count for nothing.
  void addFace(std::uint32_t face, TextureMean& mean) const {
    const auto points = scene_.faces[face];
    const std::size_t first = scene_.faces.begin[face];
    const auto uv = [&](std::size_t i) -> std::optional<glm::dvec2> {
      const std::size_t at = first + i;
      const std::uint32_t index =
          at < coordinates_.corners.size() ? coordinates_.corners[at] : TextureCoordinates::kNone;
      return index == TextureCoordinates::kNone ? std::nullopt
                                                : std::optional<glm::dvec2>(coordinates_.values[index]);
    };
    const glm::dvec3 a = scene_.points[points[0]];
    for (std::size_t i = 1; i + 1 < points.size(); ++i) {
      const auto corners = std::array{uv(0), uv(i), uv(i + 1)};
      if (corners[0] && corners[1] && corners[2]) {
        const double area =
            0.5 * glm::length(glm::cross(scene_.points[points[i]] - a, scene_.points[points[i + 1]] - a));
        mean.add(area, {*corners[0], *corners[1], *corners[2]});
      }
    }
  }

  /// Null, with a diagnosis, where it cannot be read. Each file is read once.
  std::shared_ptr<const Picture> pictureOf(const std::filesystem::path& folder, const MtlTexture& texture) {
    const auto file = fileInside(folder, texture.name);
    if (!file) {
      addDiagnosis(scene_.diagnoses, {"C136",
                                      "pictures outside the model's folder are not read: the material's "
                                      "colour stands for them",
                                      texture.where + " " + cleanName(texture.name)});
      return nullptr;
    }
    const auto [entry, isNew] = pictures_.try_emplace(*file);
    if (isNew) {
      try {
        const std::string bytes = readWholeFile(*file, "picture", kMaxPictureBytes);
        entry->second =
            std::make_shared<const Picture>(readPicture(bytes, file->string(), PictureEncoding::sRgb));
      } catch (const InputError& error) {
        addDiagnosis(scene_.diagnoses,
                     {"C126", "pictures that cannot be read: the material's colour stands for them",
                      texture.where + ": " + error.what()});
      }
    }
    return entry->second;
  }

  const TextureCoordinates& coordinates_;
  Scene& scene_;
  std::map<std::filesystem::path, std::shared_ptr<const Picture>> pictures_;
};

}  // namespace

void applyTextures(std::vector<MtlMaterial>& materials, const TextureCoordinates& coordinates, Scene& scene) {
  const auto isTextured = [](const MtlMaterial& material) { return material.color || material.luminance; };
  if (std::none_of(materials.begin(), materials.end(), isTextured)) {
    return;
  }
  std::vector<std::uint32_t> faces(scene.faces.size());
  std::iota(faces.begin(), faces.end(), 0U);
  const auto materialOf = [&](std::uint32_t face) { return scene.faceMaterial[face]; };
  std::stable_sort(faces.begin(), faces.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return materialOf(a) < materialOf(b); });
  ObjTextures textures(coordinates, scene);
  for (std::uint32_t material = 0; material < materials.size(); ++material) {
    const auto begin = std::partition_point(faces.begin(), faces.end(),
                                            [&](std::uint32_t face) { return materialOf(face) < material; });
    const auto end = std::partition_point(begin, faces.end(),
                                          [&](std::uint32_t face) { return materialOf(face) == material; });
    if (isTextured(materials[material])) {
      textures.apply(materials[material], {begin, end});
    }
  }
}

}  // namespace clerestory
