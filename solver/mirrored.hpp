// SPDX-License-Identifier: GPL-3.0-or-later
// Light outdoors that reaches a receiver over clear panes: no link knows of that way.
#pragma once

#include "interaction.hpp"

namespace clerestory {

/// Adds to `incoming` what an element outdoors gets of unshot light from surfaces that it sees in clear
/// panes, which mirror by Fresnel's share what they do not let through, over `mirrorDepth` panes at most. By
/// `rays` cosine rays from points all over the element, without bias; what they see straight does not count.
/// `treeSideOf`: #sides of the building, the tree's side or noNode.
template <int K>
void receiveMirrored(const World& world, const Hierarchy& tree, const Unshot<K>& unshot,
                     std::span<const std::uint32_t> treeSideOf, const Receiver& receiver, std::uint32_t rays,
                     Columns<K>& incoming_lx);

}  // namespace clerestory
