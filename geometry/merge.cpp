// SPDX-License-Identifier: GPL-3.0-or-later
// Coplanar neighbours of one object and material become maximal planar polygons with holes.
#include "merge.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "outline.hpp"
#include "planeclusters.hpp"

namespace clerestory {
namespace {

struct FlatRing {
  Loop loop;
  std::vector<glm::dvec2> flat;
  double area_m2;
  glm::dvec2 low, high;
};

FlatRing flatten(const Soup& soup, const PlaneFrame& frame, Loop loop) {
  FlatRing ring{std::move(loop), {}, 0.0, glm::dvec2(1e300), glm::dvec2(-1e300)};
  for (const std::uint32_t corner : ring.loop) {
    ring.flat.push_back(frame.project(soup.points[corner]));
    ring.low = glm::min(ring.low, ring.flat.back());
    ring.high = glm::max(ring.high, ring.flat.back());
  }
  for (std::size_t i = 2; i < ring.flat.size(); ++i) {
    ring.area_m2 += 0.5 * cross2(ring.flat[i - 1] - ring.flat[0], ring.flat[i] - ring.flat[0]);
  }
  return ring;
}

bool holds(const FlatRing& ring, const glm::dvec2& point) {
  if (point.x < ring.low.x || point.y < ring.low.y || point.x > ring.high.x || point.y > ring.high.y)
    return false;
  bool inside = false;
  for (std::size_t i = 0, j = ring.flat.size() - 1; i < ring.flat.size(); j = i++) {
    const glm::dvec2& a = ring.flat[i];
    const glm::dvec2& b = ring.flat[j];
    if ((a.y > point.y) != (b.y > point.y) && point.x < (b.x - a.x) * (point.y - a.y) / (b.y - a.y) + a.x) {
      inside = !inside;
    }
  }
  return inside;
}

/// Where several lines nearly meet, their crossings leave rings that have none.
bool hasSize(const FlatRing& ring, const Tolerances& tolerances) {
  double outline_m = 0.0;
  for (std::size_t i = 0, j = ring.flat.size() - 1; i < ring.flat.size(); j = i++)
    outline_m += glm::length(ring.flat[i] - ring.flat[j]);
  const double area_m2 = std::abs(ring.area_m2);
  return area_m2 >= tolerances.degenerateArea_m2 && 4.0 * area_m2 >= tolerances.collinear_m * outline_m;
}

/// Gives each hole to the smallest outer ring around it.
std::vector<PlanarPolygon> nest(std::vector<FlatRing> rings) {
  std::vector<PlanarPolygon> result;
  std::vector<const FlatRing*> outers;
  for (FlatRing& ring : rings) {
    if (ring.area_m2 <= 0.0) continue;
    outers.push_back(&ring);
    result.push_back({.outer = ring.loop});
  }
  for (FlatRing& ring : rings) {
    if (ring.area_m2 > 0.0) continue;
    std::size_t best = outers.size();
    const glm::dvec2 sample = 0.5 * (ring.flat[0] + ring.flat[1]);
    for (std::size_t i = 0; i < outers.size(); ++i) {
      if (outers[i]->area_m2 > -ring.area_m2 && holds(*outers[i], sample) &&
          (best == outers.size() || outers[i]->area_m2 < outers[best]->area_m2)) {
        best = i;
      }
    }
    if (best < outers.size()) result[best].holes.push_back(std::move(ring.loop));
  }
  return result;
}

/// Corners where rings touch: each of these rings needs its own.
Loop sharedCorners(const std::vector<Loop>& rings) {
  Loop all;
  for (const Loop& ring : rings) all.insert(all.end(), ring.begin(), ring.end());
  std::sort(all.begin(), all.end());
  Loop shared;
  for (std::size_t i = 1; i < all.size(); ++i) {
    if (all[i] == all[i - 1]) shared.push_back(all[i]);
  }
  return shared;
}

/// Finds the side of each polygon that most of the area of the faces at its corners is drawn for.
void findDrawnSides(const Soup& soup, std::span<const Face> faces, const glm::dvec3& normal,
                    std::vector<PlanarPolygon>& polygons) {
  constexpr double even = 1e-3;  // share of the area that tells one side from both
  struct Votes {
    double front_m2 = 0.0, all_m2 = 0.0;  // front less back
  };
  std::unordered_map<std::uint32_t, Votes> votesAt;  // by corner
  for (const Face& face : faces) {
    const DrawnSides& drawn = soup.drawn[face.index];
    const bool isFront = drawn.front == (glm::dot(face.normal, normal) > 0.0);
    for (const std::uint32_t corner : soup.faces[face.index]) {
      Votes& votes = votesAt[corner];
      votes.all_m2 += face.area_m2;
      if (!drawn.areBoth()) votes.front_m2 += isFront ? face.area_m2 : -face.area_m2;
    }
  }
  for (PlanarPolygon& polygon : polygons) {
    Votes sum;
    for (const std::uint32_t corner : polygon.outer) {
      sum.front_m2 += votesAt[corner].front_m2;
      sum.all_m2 += votesAt[corner].all_m2;
    }
    const double least_m2 = even * sum.all_m2;
    polygon.drawn = {sum.front_m2 >= -least_m2, sum.front_m2 <= least_m2};
  }
}

/// Unit normal of the plane of faces as they were drawn, with the canonical sign.
glm::dvec3 meanNormal(std::span<const Face> faces) {
  glm::dvec3 sum(0.0);
  for (const Face& face : faces) {
    const double sign = glm::dot(face.normal, faces[0].normal) < 0.0 ? -1.0 : 1.0;
    sum += sign * face.area_m2 * face.normal;
  }
  const glm::dvec3 normal = glm::normalize(sum);
  return normal * canonicalSign(normal);
}

/// Turns the faces of one plane, by falling area, into polygons.
void mergeFaces(Soup& soup, const Tolerances& tolerances, std::span<const Face> faces,
                std::vector<PlanarPolygon>& result, Findings& findings) {
  const Face& seed = faces[0];
  const std::uint32_t object = soup.object[seed.index];
  const glm::dvec3 normal = meanNormal(faces);
  const PlaneFrame frame(normal, seed.middle);
  std::vector<PlanarPolygon> polygons;
  if (std::optional<Outline> outline = outlineOf(soup, tolerances, frame, faces)) {
    const Loop shared = sharedCorners(outline->rings);
    std::vector<FlatRing> flat;
    for (Loop& ring : outline->rings) {
      dropCollinearCorners(soup.points, tolerances.collinear_m, ring, shared);
      if (ring.size() < 3) continue;
      FlatRing flatRing = flatten(soup, frame, std::move(ring));
      if (hasSize(flatRing, tolerances)) flat.push_back(std::move(flatRing));
    }
    polygons = nest(std::move(flat));
    if (outline->overlaps) {
      double area_m2 = 0.0;
      for (const Face& face : faces) area_m2 += face.area_m2;
      findings.note("G204", soup.points, soup.faces[seed.index], object, area_m2);
    }
    findDrawnSides(soup, faces, normal, polygons);
  } else {
    for (const Face& face : faces) {
      const auto corners = soup.faces[face.index];
      polygons.push_back({.outer = Loop(corners.begin(), corners.end()), .drawn = soup.drawn[face.index]});
      findings.note("G205", soup.points, corners, object, face.area_m2);
    }
  }
  for (PlanarPolygon& polygon : polygons) {
    polygon.material = soup.material[seed.index];
    polygon.object = object;
    polygon.normal = normal;
    result.push_back(std::move(polygon));
  }
}

}  // namespace

void dropCollinearCorners(std::span<const glm::dvec3> points, double tolerance_m, Loop& loop,
                          std::span<const std::uint32_t> needed) {
  for (bool changed = true; changed && loop.size() >= 3;) {
    startAtSmallest(points, loop);
    Loop kept{loop[0]};
    for (std::size_t i = 1; i < loop.size(); ++i) {
      const glm::dvec3& before = points[kept.back()];
      const glm::dvec3 way = points[loop[(i + 1) % loop.size()]] - before;
      const glm::dvec3 offset = points[loop[i]] - before;
      const double length = glm::length(way);
      const double along = glm::dot(offset, way);
      const bool onLine = along > 0.0 && along < length * length &&
                          glm::length(glm::cross(offset, way)) <= tolerance_m * length;
      if (!onLine || std::binary_search(needed.begin(), needed.end(), loop[i])) kept.push_back(loop[i]);
    }
    changed = kept.size() != loop.size();
    loop = std::move(kept);
  }
}

std::vector<PlanarPolygon> mergeCoplanar(Soup& soup, const Tolerances& tolerances, Findings& findings) {
  std::vector<PlanarPolygon> result;
  for (const std::vector<Face>& faces : facesByPlane(soup, tolerances)) {
    mergeFaces(soup, tolerances, faces, result, findings);
  }
  findings.tell("G204",
                "surfaces whose faces overlap in one plane; each part counts once; the largest is named");
  findings.tell("G205", "faces that cross in one plane were left as drawn; the largest is named");
  return result;
}

}  // namespace clerestory
