// SPDX-License-Identifier: GPL-3.0-or-later
// Finds elements whose bright leaves make up most of them, the largest such.
#include "bright.hpp"

namespace clerestory {
namespace {

constexpr float brighter = 8.0F;       // than the mean exitance
constexpr float shareLeast = 0.5F;     // of an element's area
constexpr float powerLeast = 0.005F;   // of all that is reflected
constexpr float togetherLeast = 0.1F;  // likewise: less is met by rays often enough

template <int K>
class BrightParts {
 public:
  BrightParts(const ColumnLayout& layout, Radiosity<K>& radiosity)
      : tree_(radiosity.tree), radiosity_(radiosity), power_lm_(tree_.size()), brightArea_m2_(tree_.size()) {
    float area_m2 = 0.0F;
    for (NodeIndex node = 0; node < tree_.size(); ++node) {
      if (tree_.isCluster(node) || !tree_.isLeaf(node)) continue;
      const Columns<K> irradiance_lx = radiosity.irradiance_lx[node] + radiosity.sunlightOf(layout, node);
      power_lm_[node] =
          tree_.area_m2[node] * layout.strength(radiosity.reflectance[tree_.treeSide[node]] * irradiance_lx);
      reflected_lm_ += power_lm_[node];
      area_m2 += tree_.area_m2[node];
    }
    mean_lm_m2_ = reflected_lm_ / area_m2;
  }

  void find() {
    for (NodeIndex node = static_cast<NodeIndex>(tree_.size()); node-- > 0;) {
      if (tree_.isCluster(node)) continue;
      if (tree_.isLeaf(node)) {
        const bool isBright = power_lm_[node] > brighter * mean_lm_m2_ * tree_.area_m2[node];
        brightArea_m2_[node] = isBright ? tree_.area_m2[node] : 0.0F;
        continue;
      }
      const NodeIndex first = tree_.firstChild[node];
      power_lm_[node] = power_lm_[first] + power_lm_[first + 1];
      brightArea_m2_[node] = brightArea_m2_[first] + brightArea_m2_[first + 1];
    }
    for (const TreeSide& side : tree_.sides) collect(side.root);
    if (found_lm_ < togetherLeast * reflected_lm_) {
      radiosity_.brightParts.clear();
      return;
    }
    radiosity_.isInBrightPart.assign(tree_.size(), 0);
    for (const BrightPart& part : radiosity_.brightParts) mark(part.node);
  }

 private:
  void collect(NodeIndex node) {
    if (brightArea_m2_[node] <= 0.0F || power_lm_[node] < powerLeast * reflected_lm_) return;
    if (brightArea_m2_[node] >= shareLeast * tree_.area_m2[node]) {
      found_lm_ += power_lm_[node];
      radiosity_.brightParts.push_back({node, power_lm_[node] / tree_.area_m2[node]});
      return;
    }
    for (NodeIndex child = tree_.firstChild[node], i = 0; i < 2; ++i) collect(child + i);
  }

  void mark(NodeIndex node) {
    radiosity_.isInBrightPart[node] = 1;
    if (tree_.isLeaf(node)) return;
    for (NodeIndex child = tree_.firstChild[node], i = 0; i < 2; ++i) mark(child + i);
  }

  const Hierarchy& tree_;
  Radiosity<K>& radiosity_;
  std::vector<float> power_lm_, brightArea_m2_;  // #nodes
  float mean_lm_m2_ = 0.0F, reflected_lm_ = 0.0F, found_lm_ = 0.0F;
};

}  // namespace

template <int K>
void findBrightParts(const ColumnLayout& layout, Radiosity<K>& radiosity) {
  BrightParts<K>(layout, radiosity).find();
}

#define CLERESTORY_INSTANTIATE(K) template void findBrightParts<K>(const ColumnLayout&, Radiosity<K>&);
CLERESTORY_STUDY_WIDTHS(CLERESTORY_INSTANTIATE)

}  // namespace clerestory
