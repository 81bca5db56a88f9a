// SPDX-License-Identifier: GPL-3.0-or-later
// The same faces as other programs' readers find in good files.
#include <assimp/Importer.hpp>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <tiny_obj_loader.h>

#include <limits>

#include <import/scene.hpp>

#include "tempfolder.hpp"

namespace clerestory {
namespace {

/// What a reader found, in the file's own axes.
struct Found {
  std::size_t triangles = 0;  ///< that the polygons have as fans
  double area = 0.0;
  glm::dvec3 low{std::numeric_limits<double>::max()};
  glm::dvec3 high{std::numeric_limits<double>::lowest()};

  /// By the fan of its first corner: the same sum for all readers, whatever the polygon's shape.
  void add(const std::vector<glm::dvec3>& face) {
    triangles += face.size() - 2;
    for (const glm::dvec3& point : face) {
      low = glm::min(low, point);
      high = glm::max(high, point);
    }
    for (std::size_t i = 1; i + 1 < face.size(); ++i) {
      area += 0.5 * glm::length(glm::cross(face[i] - face[0], face[i + 1] - face[0]));
    }
  }
};

Found ourFaces(const std::filesystem::path& file) {
  ModelOptions options;
  options.units = "m";
  options.upAxis = "z";
  options.subdivide = {{"*", "none", {}}};
  const Scene scene = readModel(file, options);
  Found found;
  for (std::size_t f = 0; f < scene.faces.size(); ++f) {
    std::vector<glm::dvec3> face;
    for (const std::uint32_t corner : scene.faces[f]) {
      face.push_back(scene.points[corner]);
    }
    found.add(face);
  }
  return found;
}

Found tinyobjFaces(const std::filesystem::path& file) {
  tinyobj::ObjReaderConfig config;
  config.triangulate = false;
  tinyobj::ObjReader reader;
  EXPECT_TRUE(reader.ParseFromFile(file.string(), config)) << reader.Error();
  Found found;
  const std::vector<float>& v = reader.GetAttrib().vertices;
  for (const tinyobj::shape_t& shape : reader.GetShapes()) {
    std::size_t at = 0;
    for (const auto count : shape.mesh.num_face_vertices) {
      std::vector<glm::dvec3> face;
      for (std::size_t i = 0; i < count; ++i, ++at) {
        const auto p = 3 * static_cast<std::size_t>(shape.mesh.indices[at].vertex_index);
        face.emplace_back(v[p], v[p + 1], v[p + 2]);
      }
      if (face.size() > 2) {
        found.add(face);
      }
    }
  }
  return found;
}

Found assimpFaces(const std::filesystem::path& file) {
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile(file.string(), aiProcess_PreTransformVertices);
  Found found;
  EXPECT_NE(scene, nullptr) << importer.GetErrorString();
  for (unsigned m = 0; scene != nullptr && m < scene->mNumMeshes; ++m) {
    const aiMesh& mesh = *scene->mMeshes[m];
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      std::vector<glm::dvec3> face;
      for (unsigned i = 0; i < mesh.mFaces[f].mNumIndices; ++i) {
        const aiVector3D& p = mesh.mVertices[mesh.mFaces[f].mIndices[i]];
        face.emplace_back(p.x, p.y, p.z);
      }
      if (face.size() > 2) {
        found.add(face);
      }
    }
  }
  return found;
}

void expectSame(const Found& ours, const Found& theirs) {
  EXPECT_EQ(ours.triangles, theirs.triangles);
  EXPECT_NEAR(ours.area / theirs.area, 1.0, 1e-4);  // theirs are floats
  const double size = glm::length(theirs.high - theirs.low);
  EXPECT_LT(glm::length(ours.low - theirs.low), 1e-6 * size + 1e-6 * glm::length(theirs.low));
  EXPECT_LT(glm::length(ours.high - theirs.high), 1e-6 * size + 1e-6 * glm::length(theirs.high));
}

std::vector<std::filesystem::path> files(std::initializer_list<const char*> further,
                                         const std::string& sample) {
  std::vector<std::filesystem::path> list{std::filesystem::path(CLERESTORY_SAMPLES) / "office" / sample};
  for (const char* name : further) {
    if (!std::string(CLERESTORY_MODELS).empty()) {
      list.push_back(std::filesystem::path(CLERESTORY_MODELS) / name);
    }
  }
  return list;
}

TEST(OtherReaders, TinyobjloaderFindsTheSame) {
  for (const auto& file :
       files({"room-sh3d-Studio/Studio.obj", "room-duplex-ifc/duplex_webifc.obj",
              "room-duplex-ifc/duplex_assimp_ngons.obj", "room-lbnl-openplan/frads_openplan.obj",
              "room-honeybee/single_family_home.obj", "import-tinyobj/cornell_box.obj",
              "import-tinyobj/issue-161-inconsistent-f.obj"},
             "office.obj")) {
    SCOPED_TRACE(file.string());
    expectSame(ourFaces(file), tinyobjFaces(file));
  }
}

TEST(OtherReaders, AssimpFindsTheSame) {
  for (const auto& file : files({"room-hotel-glb/hotel-room.glb", "import-trimesh/nested.glb",
                                 "import-trimesh/rgb_cube_with_primitives.gltf",
                                 "import-gltf-primitive-modes/Mesh_PrimitiveMode_06.gltf"},
                                "office.glb")) {
    SCOPED_TRACE(file.string());
    expectSame(ourFaces(file), assimpFaces(file));
  }
}

}  // namespace
}  // namespace clerestory
