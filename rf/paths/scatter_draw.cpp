// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/paths/scatter_draw.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace greatx::rf {

namespace {

/// Cells for each draw: with more of them, the strata follow delay and place more closely.
constexpr double cells_of_draw = 8.0;
constexpr uint32_t most_bins = 4096;

/// A node that is not opened further, with what it sends to the target.
struct Cell {
  uint32_t node = 0, bin = 0;
  double power = 0.0;
};

/// A bin of delay with its share of the budget. Bins share it by the powers to the exponent 2/3: an exponent of
/// 1 would be best for the sum, and 0 for the bins.
struct Bin {
  double power = 0.0, weight = 0.0;
  uint32_t cells = 0, draws = 0;
};

class Strata {
 public:
  Strata(const ScatterTree& tree, const dvec3& target, uint32_t budget)
      : tree_(tree), target_(target), budget_(budget) {}

  std::vector<ScatterDraw> draw() {
    find_cells();
    share_out();
    // A cell with more power than a stratum of its bin is opened, because it would have to be drawn twice.
    while (
        open([this](const Cell& cell) { return cell.power > bins_[cell.bin].power / bins_[cell.bin].draws; }))
      share_out();
    std::vector<ScatterDraw> draws;
    std::vector<std::vector<uint32_t>> of_bin(bins_.size());
    for (uint32_t i = 0; i < cells_.size(); ++i) of_bin[cells_[i].bin].push_back(i);
    for (uint32_t b = 0; b < bins_.size(); ++b) draw_bin(of_bin[b], bins_[b].draws, draws);
    return draws;
  }

 private:
  const ScatterTree::Node& node_of(const Cell& cell) const { return tree_.nodes()[cell.node]; }

  void add(std::vector<Cell>& cells, uint32_t node) const {
    const double power = tree_.to(tree_.nodes()[node], target_);
    if (power > 0.0) cells.push_back({node, 0, power});
  }

  /// Replaces the cells that are nodes with children, and for which `wanted` holds, by their children, in
  /// order. Returns whether there was one.
  template <typename Wanted>
  bool open(const Wanted& wanted) {
    std::vector<Cell> next;
    next.reserve(cells_.size() + 64);
    bool opened = false;
    for (const Cell& cell : cells_) {
      const uint32_t second = node_of(cell).second;
      if (second == ScatterTree::none || !wanted(cell)) {
        next.push_back(cell);
        continue;
      }
      add(next, cell.node + 1);
      add(next, second);
      opened = true;
    }
    cells_ = std::move(next);
    return opened;
  }

  /// Opens nodes until none has more than a small part of the power. Their number does not depend on that of
  /// the scatterers.
  void find_cells() {
    cells_.clear();
    add(cells_, 0);
    double least = 0.0;
    do {
      double total = 0.0;
      for (const Cell& cell : cells_) total += cell.power;
      least = total / (cells_of_draw * budget_);
    } while (open([&](const Cell& cell) { return cell.power > least; }));
  }

  /// Puts the cells into bins, which share the budget.
  void share_out() {
    std::vector<double> lengths;
    lengths.reserve(cells_.size());
    double shortest = 1e300, longest = 0.0;
    for (const Cell& cell : cells_) {
      const ScatterTree::Node& node = node_of(cell);
      lengths.push_back(node.length_m + glm::length(target_ - node.center));
      shortest = std::min(shortest, lengths.back()), longest = std::max(longest, lengths.back());
    }
    // The bins are wider if they are too many for the budget.
    const double span = std::max(0.0, longest - shortest);
    const double most = std::min<double>(most_bins, std::max(1.0, 0.25 * budget_));
    const double width = span / delay_bin_m < most - 1.0 ? delay_bin_m : span / most;
    // Bins of the usual width begin where those of every link do.
    const double origin = width == delay_bin_m ? delay_bin_m * std::floor(shortest / delay_bin_m) : shortest;
    const auto last = static_cast<uint32_t>(most) - 1;
    bins_.assign(static_cast<size_t>(last) + 1, {});
    for (size_t i = 0; i < cells_.size(); ++i) {
      Cell& cell = cells_[i];
      cell.bin = std::min(last, static_cast<uint32_t>(std::max(0.0, (lengths[i] - origin) / width)));
      bins_[cell.bin].power += cell.power;
      ++bins_[cell.bin].cells;
    }
    // A bin that has all its cells leaves the rest of its share to the others.
    uint32_t left = budget_;
    for (Bin& bin : bins_) {
      bin.weight = std::cbrt(bin.power * bin.power);
      if (bin.cells > 0) bin.draws = 1, --left;
    }
    for (int round = 0; round < 4; ++round) {
      double weights = 0.0;
      for (const Bin& bin : bins_)
        if (bin.draws < bin.cells) weights += bin.weight;
      if (weights == 0.0) break;
      const double share = left / weights;
      for (Bin& bin : bins_) {
        if (bin.draws >= bin.cells) continue;
        const auto more = static_cast<uint32_t>(share * bin.weight);
        const uint32_t taken = std::min({more, bin.cells - bin.draws, left});
        bin.draws += taken, left -= taken;
      }
    }
  }

  void add_draw(const Cell& cell, double stratum_power, bool alone, std::vector<ScatterDraw>& draws) {
    const ScatterTree::Node& node = node_of(cell);
    const double own = tree_.scatterers()[node.drawn].power;
    draws.push_back({node.drawn, stratum_power / cell.power * (node.power / own), alone ? 0 : ++strata_});
  }

  /// Draws `count` of the cells of a bin.
  void draw_bin(std::vector<uint32_t>& cells, uint32_t count, std::vector<ScatterDraw>& draws) {
    double power = 0.0;
    for (const uint32_t i : cells) power += cells_[i].power;
    // Single scatterers with the power of a stratum or more stand for themselves. Without them the strata
    // of the others have less.
    for (bool again = true; again && count > 0;) {
      again = false;
      const double stratum = power / count;
      std::erase_if(cells, [&](uint32_t i) {
        const Cell& cell = cells_[i];
        if (count == 0 || cell.power < stratum || node_of(cell).second != ScatterTree::none) return false;
        if (cells.size() > 1 && count == 1) return false;
        add_draw(cell, cell.power, true, draws);
        power -= cell.power, --count;
        again = true;
        return true;
      });
      if (cells.empty()) return;
    }
    power = 0.0;
    for (const uint32_t i : cells) power += cells_[i].power;
    const double stratum = power / count;
    double before = 0.0;
    for (size_t first = 0; first < cells.size();) {
      const auto number_of = [&](double at) { return std::min(count - 1.0, std::floor(at / stratum)); };
      const double number = number_of(before + 0.5 * cells_[cells[first]].power);
      double sum = 0.0, least = 1e300;
      uint32_t winner = cells[first];
      size_t last = first;
      for (; last < cells.size(); ++last) {
        const Cell& cell = cells_[cells[last]];
        if (number_of(before + 0.5 * cell.power) != number) break;
        before += cell.power, sum += cell.power;
        const double clock = node_of(cell).clock * node_of(cell).power / cell.power;
        if (clock < least) least = clock, winner = cells[last];
      }
      const bool alone = last - first == 1 && node_of(cells_[winner]).second == ScatterTree::none;
      add_draw(cells_[winner], sum, alone, draws);
      first = last;
    }
  }

  const ScatterTree& tree_;
  dvec3 target_;
  uint32_t budget_;
  uint32_t strata_ = 0;
  std::vector<Cell> cells_;  ///< in the order of the tree
  std::vector<Bin> bins_;
};

}  // namespace

std::vector<ScatterDraw> draw_scatterers(const ScatterTree& tree, const dvec3& target, uint32_t budget) {
  GREATX_CHECK(budget > 0, "a budget of {}", budget);
  std::vector<ScatterDraw> draws;
  if (tree.scatterers().size() <= budget) {
    for (uint32_t i = 0; i < tree.scatterers().size(); ++i) draws.push_back({i, 1.0, 0});
    return draws;
  }
  return Strata(tree, target, budget).draw();
}

double scattered_deviation(std::span<const Path> paths) {
  std::vector<double> strata;
  for (const Path& path : paths) {
    if (path.stratum == 0) continue;
    if (strata.size() < path.stratum) strata.resize(path.stratum);
    for (const Complex& t : path.transfer) strata[path.stratum - 1] += 0.5 * std::norm(t);
  }
  double variance = 0.0;
  if (strata.size() % 2 == 1) strata.push_back(0.0);
  for (size_t i = 0; i + 1 < strata.size(); i += 2)
    variance += (strata[i] - strata[i + 1]) * (strata[i] - strata[i + 1]);
  return std::sqrt(variance);
}

}  // namespace greatx::rf
