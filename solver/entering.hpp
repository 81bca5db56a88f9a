// SPDX-License-Identifier: GPL-3.0-or-later
// Light of a domain that no node of its tree sends: from portals and luminaires, or from the sky where no
// glass is between. It enters in the first step.
#pragma once

#include <cstdint>
#include <vector>

#include "exchange.hpp"
#include "portals.hpp"
#include "receiver.hpp"

namespace clerestory {

template <int K>
class EnteringLight {
 public:
  /// `mirrorsPatches`: clear panes mirror the patches of sun in the room to their receivers, who then are not
  /// to get it from the panes as from other surfaces.
  EnteringLight(const SolvedLight<K>& light, std::int32_t domain, const Hierarchy& tree,
                const TransportSettings& settings, bool mirrorsPatches);

  /// Portals of the domain or the open sky, and luminaires.
  [[nodiscard]] std::vector<Sender> senders() const;
  /// Light that enters by the portals. [lm]
  [[nodiscard]] Columns<K> portalFlux_lm() const;
  /// Light of the domain's luminaires. [lm]
  [[nodiscard]] Columns<K> lampFlux_lm() const;

  /// What an interaction may err by, and whether its receiver may be divided to err by less.
  struct Limits {
    float threshold_lm;
    bool mayDivide;
  };
  /// Light from one of the senders: judged, and on `accept` added at once.
  Verdict receive(const Receiver& receiver, Sender sender, const Limits& limits, Incoming<K>& incoming,
                  Tally& tally) const;

 private:
  Verdict receiveFromSky(const Receiver& receiver, Incoming<K>& incoming, Tally& tally) const;
  Verdict receiveFromPortal(const Receiver& receiver, const PortalSender<K>& portal, const Limits& limits,
                            Incoming<K>& incoming, Tally& tally) const;
  Verdict receiveFromLamp(const Receiver& receiver, std::uint32_t number, const Limits& limits,
                          Incoming<K>& incoming, Tally& tally) const;

  const SolvedLight<K>& light_;
  const World& world_;
  const Hierarchy& tree_;
  std::uint32_t skyRays_;
  std::int32_t domain_;
  bool isOpen_;
  std::vector<PortalSender<K>> portals_;
};

}  // namespace clerestory
