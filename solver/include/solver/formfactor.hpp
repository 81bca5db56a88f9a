// SPDX-License-Identifier: GPL-3.0-or-later
// Unoccluded form factors to polygons: from a point (Lambert's closed form) and from a polygon (reference
// quadrature).
#pragma once

#include <glm/vec3.hpp>

#include <cstddef>
#include <span>

namespace clerestory {

/// Unoccluded form factor from a point with a unit normal to a planar polygon, exact. [0..1]
/// The polygon has at least 3 corners, any number of them, convex or not, without self-intersection. What
/// lies below the receiver's horizon is cut off; either winding and either side of the polygon counts, so the
/// caller has checked facing. Lambert's contour sum; an area quadrature where the polygon is so small for its
/// distance (1/5000) that the sum would cancel. No allocation.
/// A point on the polygon gets the limit of moving to it within its own horizon plane from the polygon's
/// front, the counter-clockwise side (1/2 at the foot of a perpendicular wall, 1/4 at its corner); one in a
/// coplanar polygon gets 0. Error: 1e-15 absolute; relative 1e-11 for plump polygons of any size and distance
/// unless seen edge-on, and 1e-15 over the apparent width in radians for slivers.
double pointToPolygon(glm::dvec3 point, glm::dvec3 normal, std::span<const glm::dvec3> polygon);

/// The same for hot loops: float in and out, double inside, no libm but sqrt, the area form from 1/32 on.
/// Error against the double form on the same corners: 1e-7 absolute; relative 2e-6 for plump polygons.
float pointToPolygon(glm::vec3 point, glm::vec3 normal, std::span<const glm::vec3> polygon);

/// The same from several points that share a normal, in less time than one by one. #points form factors.
void pointsToPolygon(std::span<const glm::vec3> points, glm::vec3 normal, std::span<const glm::vec3> polygon,
                     std::span<float> formFactors);

/// Unoccluded form factor from a polygon to another, the mean of pointToPolygon over the receiver. [0..1]
/// The receiver sees with its front, the counter-clockwise side; the sender counts from both. Adaptive
/// cubature over triangles until its estimate of the absolute error is below the tolerance (or at a million
/// triangles), so the polygons may touch. Brute force to check the faster forms against: milliseconds and
/// more, allocates.
double polygonToPolygon(std::span<const glm::dvec3> receiver, std::span<const glm::dvec3> sender,
                        double tolerance = 1e-8);

/// Polygons of more corners are left to other forms: the cost grows with the product of both.
inline constexpr std::size_t contourCornersMost = 16;

/// Unoccluded form factor from a convex polygon to another, the mean over the receiver, for hot loops and
/// near polygons: they may touch or cut each other's planes. [0..1] `contourCornersMost` corners at most, in
/// either winding; only what lies in front of the other, where its unit normal looks, counts. Integral around
/// both outlines with four points an edge. Relative error: below 0.1 % where they share an edge, 0.4 % where
/// a small one lies on a large one's edge; absolute: rounding to 1e-9 of the squared distance over the area,
/// so far and tiny ones have better forms.
float meanFormFactor(std::span<const glm::vec3> receiver, const glm::vec3& receiverNormal, float area_m2,
                     std::span<const glm::vec3> sender, const glm::vec3& senderNormal);

}  // namespace clerestory
