// SPDX-License-Identifier: GPL-3.0-or-later
// Adds elements up to surfaces.
#include "surfaces.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace clerestory {
namespace {

/// Adds a leaf to the mesh, with the light of its plane at each corner.
template <int K>
void drawElement(const ColumnLayout& layout, const Radiosity<K>& radiosity, NodeIndex leaf,
                 ElementMesh& mesh) {
  const Hierarchy& tree = radiosity.tree;
  const std::span<const glm::vec3> polygon = tree.polygon(leaf);
  const std::uint32_t side = tree.treeSide[leaf];
  glm::vec3 turn(0.0F);
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    turn += glm::cross(polygon[i - 1] - polygon[0], polygon[i] - polygon[0]);
  }
  const Columns<K> sunlight_lx = radiosity.sunlightOf(layout, leaf);
  const bool turned = glm::dot(turn, tree.normal(leaf)) < 0.0F;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const glm::vec3& corner = polygon[turned ? polygon.size() - 1 - i : i];
    const Columns<K> irradiance_lx = radiosity.irradianceAt(leaf, corner) + sunlight_lx;
    mesh.corners_m.push_back(corner);
    mesh.illuminance_lx.push_back(static_cast<float>(luminanceOf(layout.totalColour(irradiance_lx))));
    mesh.exitance_lm_m2.emplace_back(
        layout.totalColour(radiosity.reflectance[side] * irradiance_lx + radiosity.exitance_lm_m2[side]));
  }
  mesh.firstCorner.push_back(static_cast<std::uint32_t>(mesh.corners_m.size()));
}

/// A row while it is added up.
struct Row : SurfaceValue {
  double weight = 0.0;  ///< in the oracle; outdoors, and where nothing matters more than the rest, the area
  double solverError = 0.0;  ///< relative, of its domain
};

}  // namespace

template <int K>
std::vector<SurfaceValue> measureSurfaces(const SolvedLight<K>& light, ElementMesh& mesh) {
  const World& world = light.world();
  const Building& building = world.building;
  std::map<std::pair<std::int32_t, std::uint32_t>, Row> rows;
  std::vector<const SurfaceValue*> rowOfElement;
  mesh = {};
  mesh.origin_m = world.rays.origin();
  for (std::int32_t domain = 0; domain < static_cast<std::int32_t>(building.domains.size()); ++domain) {
    const Radiosity<K>* radiosity = light.of(domain);
    if (radiosity == nullptr) continue;
    const Hierarchy& tree = radiosity->tree;
    for (NodeIndex node = 0; node < tree.size(); ++node) {
      if (tree.isCluster(node) || !tree.isLeaf(node)) continue;
      // Outdoors only what somebody looks at was solved.
      if (tree.weight[tree.sides[tree.treeSide[node]].root] <= 0.0F) continue;
      const std::uint32_t side = tree.sides[tree.treeSide[node]].side;
      const std::uint32_t piece = side / 2;
      const std::int32_t room = building.sideRoom[side];
      const std::int32_t order = room < 0 ? std::numeric_limits<std::int32_t>::max() : room;
      Row& row = rows[{order, world.pieces().surface[piece]}];
      const bool isOpen = building.domains[static_cast<std::size_t>(domain)].open;
      row.weight += static_cast<double>(isOpen ? tree.area_m2[node] : tree.weight[node]);
      const auto area_m2 = static_cast<double>(tree.area_m2[node]);
      const Columns<K> irradiance_lx =
          radiosity->irradiance_lx[node] + radiosity->sunlightOf(world.layout, node);
      const double illuminance_lx = luminanceOf(world.layout.totalColour(irradiance_lx));
      if (row.elements == 0) {
        row.surface = world.pieces().surface[piece];
        row.room = room;
        row.solverError = radiosity->solverError.surfaces;
        row.illuminanceMin_lx = row.illuminanceMax_lx = illuminance_lx;
      }
      ++row.elements;
      row.area_m2 += area_m2;
      row.illuminanceMean_lx += area_m2 * illuminance_lx;
      row.illuminanceMin_lx = std::min(row.illuminanceMin_lx, illuminance_lx);
      row.illuminanceMax_lx = std::max(row.illuminanceMax_lx, illuminance_lx);
      row.exitanceMean_lm_m2 +=
          area_m2 * world.layout.totalColour(radiosity->reflectance[tree.treeSide[node]] * irradiance_lx +
                                             radiosity->exitance_lm_m2[tree.treeSide[node]]);
      rowOfElement.push_back(&row);
      drawElement(world.layout, *radiosity, node, mesh);
    }
  }
  std::vector<SurfaceValue> result;
  std::map<const SurfaceValue*, std::uint32_t> place;
  for (auto& [key, row] : rows) {
    place[&row] = static_cast<std::uint32_t>(result.size());
    row.illuminanceMean_lx /= row.area_m2;
    row.exitanceMean_lm_m2 /= row.area_m2;
    // What weighs less than its area is solved as at an accuracy that is lower by the root of that.
    row.error_lx =
        row.solverError * row.illuminanceMean_lx * std::sqrt(std::max(row.area_m2 / row.weight, 1.0));
    result.push_back(row);
  }
  for (const SurfaceValue* row : rowOfElement) mesh.surfaceRow.push_back(place[row]);
  return result;
}

#define CLERESTORY_INSTANTIATE(K) \
  template std::vector<SurfaceValue> measureSurfaces<K>(const SolvedLight<K>&, ElementMesh&);
CLERESTORY_STUDY_WIDTHS(CLERESTORY_INSTANTIATE)

}  // namespace clerestory
