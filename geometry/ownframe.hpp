// SPDX-License-Identifier: GPL-3.0-or-later
// A model turned into its own frame: one model lies the same there however it was turned or mirrored, and so
// all that is decided by places, rounding or samples is decided the same.
#pragma once

#include "planframe.hpp"
#include "soup.hpp"

namespace clerestory {

/// The frame of a model's faces about its own origin: moving a model changes none of its digits.
PlanFrame ownFrameOf(std::span<const glm::dvec3> points, const PolygonList& polygons);

/// Whether the frame's axes are a mirror image of the model's.
inline bool isMirrored(const PlanFrame& frame) {
  return cross2(frame.along, frame.across) < 0.0;
}

/// A place given in the model's axes, in the frame's, and the other way round; upright they are the same.
inline glm::dvec3 intoFrame(const PlanFrame& frame, const glm::dvec3& place) {
  return {frame.toFrame(glm::dvec2(place)), place.z};
}
inline glm::dvec3 outOfFrame(const PlanFrame& frame, const glm::dvec3& place) {
  return {frame.toPlan(glm::dvec2(place)), place.z};
}

/// Turns pieces into the frame, on the grid there, or out of it.
void turnInto(const PlanFrame& frame, const Tolerances& tolerances, Pieces& pieces);
void turnOutOf(const PlanFrame& frame, Pieces& pieces);

}  // namespace clerestory
