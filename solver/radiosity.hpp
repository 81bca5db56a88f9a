// SPDX-License-Identifier: GPL-3.0-or-later
// A solved domain, and light seen along rays: in it, and from it through its portals to the outside.
#pragma once

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <vector>

#include "columns.hpp"
#include "hierarchy.hpp"
#include "sunlight.hpp"
#include "world.hpp"

namespace clerestory {

/// Irradiance over an element that varies evenly.
template <int K>
struct Plane {
  Columns<K> level_lx;                    ///< at the element's centroid, so its mean
  std::array<glm::vec3, K> slope_lx_m{};  ///< of each column, in the element's plane [lx/m]

  /// `way_m` leads from the centroid to the point that is asked about.
  [[nodiscard]] Columns<K> at(const glm::vec3& way_m) const {
    Columns<K> irradiance_lx = level_lx;
    for (int c = 0; c < K; ++c) irradiance_lx[c] += glm::dot(slope_lx_m[static_cast<std::size_t>(c)], way_m);
    return irradiance_lx;
  }
};

/// An element that reflects far more than others.
struct BrightPart {
  NodeIndex node;
  float exitance_lm_m2;  ///< mean, of the strongest kind of light
};

/// How far the light of a solve may be off, two standard deviations. Shares are calibrated on the reference
/// scenes (docs/validation.md).
struct SolverError {
  double surfaces = 0.0;   ///< share of a surface's mean
  double reflected = 0.0;  ///< share of the reflected light at a sensor
  double even_lx = 0.0;    ///< at any sensor alike: interactions err by shares of all light
  double gaps = 0.0;       ///< share of a sensor's light where panes show blades
  double sunInGaps = 0.0;  ///< and of its sunlight there: what the room sends out, blades send back
};

/// The light of one domain after the solve.
template <int K>
struct Radiosity {
  Hierarchy tree;
  std::vector<Columns<K>> irradiance_lx;       ///< #nodes; leaves hold all light received but the sun's beam
  std::vector<Columns<K>> reflectance;         ///< #sides of the tree
  std::vector<Columns<K>> exitance_lm_m2;      ///< #sides of the tree: own emission
  std::vector<std::uint32_t> emitters;         ///< sides of the tree that have some
  std::vector<Plane<K>> planes{};              ///< #nodes, or empty before `reconstruct`
  Sunlight sunlight{};                         ///< the beam; empty without sun
  std::vector<BrightPart> brightParts{};       ///< elements that points look at apart; none is within another
  std::vector<std::uint8_t> isInBrightPart{};  ///< #nodes, or empty
  SolverError solverError{};

  /// Irradiance of a point of a leaf: of its plane if there is one, else its mean.
  [[nodiscard]] Columns<K> irradianceAt(NodeIndex leaf, const glm::vec3& point) const {
    if (planes.empty()) return irradiance_lx[leaf];
    Columns<K> irradiance = planes[leaf].at(point - tree.centre[leaf]);
    for (int c = 0; c < K; ++c) irradiance[c] = std::max(irradiance[c], 0.0F);  // but for rounding at corners
    return irradiance;
  }
  [[nodiscard]] Columns<K> reflected(NodeIndex leaf) const {
    return reflectance[tree.treeSide[leaf]] * irradiance_lx[leaf];
  }
  /// Mean illuminance of a leaf by the sun's beam.
  [[nodiscard]] Columns<K> sunlightOf(const ColumnLayout& layout, NodeIndex leaf) const {
    if (sunlight.empty()) return {};
    return layout.template light<K>(layout.sunColumn(), glm::dvec3(sunlight.illuminance_lx[leaf]));
  }
};

/// All solved domains and the way from a side to its tree; lookups for rays.
template <int K>
class SolvedLight {
 public:
  explicit SolvedLight(const World& world)
      : world_(world),
        rootOfSide_(2 * world.pieces().size(), noNode),
        paneFactor_(world.pieces().size()),
        diffused_cd_m2_(world.pieces().size()),
        domains_(world.building.domains.size()) {
    for (std::uint32_t piece = 0; piece < paneFactor_.size(); ++piece) {
      if (!world.materialOf(piece).glazing) continue;
      paneFactor_[piece] = world.portalFactor(piece) * world.layout.template property<K>(world.tintOf(piece));
    }
  }

  void add(std::int32_t domain, Radiosity<K> radiosity);
  [[nodiscard]] const Radiosity<K>* of(std::int32_t domain) const {
    const auto& entry = domains_[static_cast<std::size_t>(domain)];
    return entry ? &*entry : nullptr;
  }

  /// Whether something outdoors that is looked at lines a gap, as blades do.
  [[nodiscard]] bool showsGaps() const { return showsGaps_; }

  /// Whether the side that a ray has met belongs to a solved domain.
  [[nodiscard]] bool isSolved(const RayScene::Hit& hit) const { return rootOfSide_[hit.side()] != noNode; }
  /// Exitance of the side that a ray has met, with or without the surface's own emission; black where
  /// unsolved.
  [[nodiscard]] Columns<K> exitance(const RayScene::Hit& hit, const glm::vec3& point,
                                    bool withEmission) const;

  /// Whether the point where a ray has met a side is within a bright part.
  [[nodiscard]] bool isInBrightPart(const RayScene::Hit& hit, const glm::vec3& point) const;

  /// Luminance seen outdoors along a ray that starts outside or on the outer face of a pane. [cd/m²]
  [[nodiscard]] Columns<K> outsideLuminance(const glm::vec3& from, const glm::vec3& direction) const;

  /// What a ray outdoors sees of sky and ground, straight or over panes that mirror it. [cd/m²]
  [[nodiscard]] Columns<K> skyAlong(const glm::vec3& from, const glm::vec3& direction) const {
    return alongOutdoors(from, direction, outdoors(from, direction), false);
  }

  /// Finds how brightly scattering panes shine inwards; to be called when the outside is solved.
  void lightDiffusingPanes();
  /// Luminance that a pane shows inside at a point of it, to one who looks along `direction`. [cd/m²]
  [[nodiscard]] Columns<K> paneLuminance(std::uint32_t piece, const glm::vec3& onPane,
                                         const glm::vec3& direction) const;

  /// Luminance that a portal's point shows towards `receiver`, after the pane's transmittance. [cd/m²]
  [[nodiscard]] Columns<K> behindPortal(const Portal& portal, const glm::vec3& receiver,
                                        const glm::vec3& onPane) const;
  /// A point of a portal.
  struct PanePoint {
    const Portal* portal;
    glm::vec3 place;
  };
  /// The same for many points that one receiver looks at, by rays in packets. `seen` (#points) receives what
  /// each shows.
  void behindPortals(const glm::vec3& receiver, std::span<const PanePoint> points,
                     std::span<Columns<K>> seen) const;
  /// `behindPortal`, and black where something stands between. [cd/m²]
  [[nodiscard]] Columns<K> throughPortal(const Portal& portal, const glm::vec3& receiver,
                                         const glm::vec3& onPane) const;

  /// Sky and ground where nothing is met. [cd/m²]
  [[nodiscard]] Columns<K> skyLuminance(const glm::vec3& direction) const;

  const World& world() const { return world_; }

 private:
  [[nodiscard]] RayScene::Hit outdoors(const glm::vec3& from, const glm::vec3& direction) const {
    return world_.rays.nearest(from, direction, RayScene::Barrier::opaqueAndGlass);
  }
  [[nodiscard]] Columns<K> alongOutdoors(glm::vec3 from, glm::vec3 direction, RayScene::Hit hit,
                                         bool withSurfaces) const;
  [[nodiscard]] Columns<K> throughGlass(std::uint32_t piece, const glm::vec3& direction,
                                        const Columns<K>& outside_cd_m2) const;

  const World& world_;
  std::vector<NodeIndex> rootOfSide_;
  std::vector<Columns<K>> paneFactor_;  // #pieces, of panes: tint, dirt and frames, beside the glass itself
  std::vector<Columns<K>> diffused_cd_m2_;  // #pieces, of scattering panes
  std::vector<std::optional<Radiosity<K>>> domains_;
  bool showsGaps_ = false;
};

}  // namespace clerestory
