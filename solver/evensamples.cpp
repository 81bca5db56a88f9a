// SPDX-License-Identifier: GPL-3.0-or-later
// The error of even samples, from pairs of neighbours.
#include "evensamples.hpp"

namespace clerestory {

float varianceWithinCells(std::span<const EvenSample> samples, float mean, float weights) {
  constexpr std::size_t sideMost = 64;
  struct Cell {
    float count = 0.0F, sum = 0.0F, squares = 0.0F;
  };
  const auto side = std::clamp(static_cast<std::size_t>(std::sqrt(0.5F * static_cast<float>(samples.size()))),
                               std::size_t{1}, sideMost);
  std::vector<Cell> cells(side * side);
  for (const EvenSample& sample : samples) {
    const auto column = static_cast<std::size_t>(sample.u * static_cast<float>(side));
    const auto row = static_cast<std::size_t>(sample.v * static_cast<float>(side));
    Cell& cell = cells[std::min(row, side - 1) * side + std::min(column, side - 1)];
    const float value = sample.weight * (sample.strength - mean) / weights;
    cell.count += 1.0F;
    cell.sum += value;
    cell.squares += value * value;
  }
  float variance = 0.0F;
  float counted = 0.0F;
  for (const Cell& cell : cells) {
    if (cell.count < 2.0F) continue;
    counted += cell.count;
    const float within = std::max(cell.squares - cell.sum * cell.sum / cell.count, 0.0F);  // but for rounding
    variance += within * cell.count / (cell.count - 1.0F);
  }
  return counted > 0.0F ? variance * static_cast<float>(samples.size()) / counted : 0.0F;
}

}  // namespace clerestory
