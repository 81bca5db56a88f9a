// SPDX-License-Identifier: GPL-3.0-or-later
// Senders that are each too weak for a link of their own: a few rays of the receiver's bring what they meet
// of them all.
#pragma once

#include "interaction.hpp"

namespace clerestory {

/// Adds what a receiver gets from `senders`, of which none holds another, by `rays` cosine rays from points
/// all over it: unbiased, whatever stands between and however close they are. Where it has children, each
/// gets what came from its own points. `treeSideOf`: #sides of the building, the tree's side or noNode.
template <int K>
void receiveFromWeak(const World& world, const Hierarchy& tree, const Unshot<K>& unshot,
                     std::span<const std::uint32_t> treeSideOf, const Receiver& receiver,
                     std::span<const NodeIndex> senders, std::uint32_t rays, Incoming<K>& incoming);

}  // namespace clerestory
