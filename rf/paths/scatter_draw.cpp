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
/// Cells that are asked for their sight first, and, if not enough of the power is seen, those for each draw.
constexpr double first_probes = 128.0, probes_of_draw = 0.25, enough_seen = 0.5;
/// A cell whose middle is hidden may hold patches that are not. It is drawn as if this share of its power
/// arrived.
constexpr double least_sight = 0.1;

/// Holds what is drawn as one: a node of the tree that is not opened further, or a single scattering.
struct Cell {
  uint32_t node = ScatterTree::none;
  uint32_t index = 0;  ///< of the scattering that is drawn for the cell
  uint32_t bin = 0;
  double power = 0.0, length_m = 0.0;  ///< at the target, with the sight
  double sight = 1.0;                  ///< share of the power that seems to arrive
  double clock = 0.0;                  ///< when the cell's clock runs out, in units of 1/power
  double factor = 1.0;                 ///< power of the cell by that of its scattering
  bool divisible = false;
};

/// A bin of delay with its share of the budget. Bins share it by the powers to the exponent 2/3: an exponent
/// of 1 would be best for the sum, and 0 for the bins.
struct Bin {
  double power = 0.0, weight = 0.0;
  uint32_t cells = 0, draws = 0;
};

class Strata {
 public:
  Strata(const ScatterTree& tree, const dvec3& target, std::span<const SingleScattering> singles,
         uint32_t budget, const Sight& sight)
      : tree_(tree), target_(target), budget_(budget) {
    if (!tree.empty()) add(cells_, 0, 1.0);
    look_around(sight);
    const auto first = static_cast<uint32_t>(tree.patches().size());
    for (uint32_t i = 0; i < singles.size(); ++i) {
      const SingleScattering& one = singles[i];
      if (one.power > 0.0)
        cells_.push_back({.index = first + i,
                          .power = one.power,
                          .length_m = one.length_m,
                          .clock = one.clock / one.power});
    }
  }

  std::vector<ScatterDraw> draw() {
    open_to(cells_of_draw * budget_);
    share_out();
    // A cell with more power than a stratum of its bin is opened, because it would have to be drawn twice.
    while (
        open([this](const Cell& cell) { return cell.power > bins_[cell.bin].power / bins_[cell.bin].draws; }))
      share_out();
    settle_cells();
    share_out();
    std::vector<std::vector<uint32_t>> of_bin(bins_.size());
    for (uint32_t i = 0; i < cells_.size(); ++i) of_bin[cells_[i].bin].push_back(i);
    for (uint32_t b = 0; b < bins_.size(); ++b)
      if (!of_bin[b].empty()) draw_bin(of_bin[b], bins_[b].draws);
    return std::move(draws_);
  }

 private:
  void add(std::vector<Cell>& cells, uint32_t index, double sight) const {
    const ScatterTree::Node& node = tree_.nodes()[index];
    const double power = sight * tree_.to(node, target_);
    if (!(power > 0.0)) return;
    cells.push_back({.node = index,
                     .index = node.drawn,
                     .power = power,
                     .length_m = node.length_m + glm::length(target_ - node.center),
                     .sight = sight,
                     .divisible = node.second != ScatterTree::none});
  }

  /// Gives each cell the delay of the patch that is drawn for it, and the power that this patch would have
  /// for it. Which patch of a node that is does not depend on when the node's clock runs out, so that the
  /// race of the cells stays fair. Whether a node is opened must not depend on it.
  void settle_cells() {
    for (Cell& cell : cells_) {
      if (cell.node == ScatterTree::none) continue;
      const ScatterTree::Node& node = tree_.nodes()[cell.node];
      const LitPatch& drawn = tree_.patches()[cell.index];
      const dvec3 way = target_ - drawn.position;
      const double distance_m = glm::length(way);
      cell.factor = node.power / drawn.power;
      cell.power = distance_m > 0.0
                       ? cell.sight * cell.factor * scattered_power(drawn, way / distance_m, distance_m)
                       : 0.0;
      cell.length_m = drawn.length_m + distance_m;
      cell.clock = node.clock * node.power / cell.power;
    }
    std::erase_if(cells_, [](const Cell& cell) { return !(cell.power > 0.0); });
  }

  /// Replaces the nodes for which `wanted` holds by their children, in order. Returns whether there was one.
  template <typename Wanted>
  bool open(const Wanted& wanted) {
    std::vector<Cell> next;
    next.reserve(cells_.size() + 64);
    bool opened = false;
    for (const Cell& cell : cells_) {
      if (!cell.divisible || !wanted(cell)) {
        next.push_back(cell);
        continue;
      }
      add(next, cell.node + 1, cell.sight);
      add(next, tree_.nodes()[cell.node].second, cell.sight);
      opened = true;
    }
    cells_ = std::move(next);
    return opened;
  }

  /// Finds out roughly what is hidden from the target.
  void look_around(const Sight& sight) {
    for (const double probes : {first_probes, probes_of_draw * budget_}) {
      open_to(probes);
      double before = 0.0, after = 0.0;
      for (Cell& cell : cells_) {
        before += cell.power / cell.sight;
        look(cell, sight);
        after += cell.power;
      }
      if (after > enough_seen * before) return;
    }
  }

  /// Asks for the sight of the middle of a cell. Which patch that is does not depend on the clocks, since the
  /// draw would otherwise depend on what it finds.
  void look(Cell& cell, const Sight& sight) {
    const ScatterTree::Node& node = tree_.nodes()[cell.node];
    const double seen =
        std::max(least_sight, sight(tree_.patches()[node.first + (node.last - node.first) / 2]));
    cell.power *= seen / cell.sight;
    cell.sight = seen;
  }

  /// Opens nodes until none has more than a small part of the power. Their number does not depend on that of
  /// the patches.
  void open_to(double cells) {
    double least = 0.0;
    do {
      double total = 0.0;
      for (const Cell& cell : cells_) total += cell.power;
      least = total / cells;
    } while (open([&](const Cell& cell) { return cell.power > least; }));
  }

  /// Puts the cells into bins, which share the budget.
  void share_out() {
    double shortest = 1e300, longest = 0.0;
    for (const Cell& cell : cells_)
      shortest = std::min(shortest, cell.length_m), longest = std::max(longest, cell.length_m);
    // The bins are wider if they are too many for the budget.
    const double span = std::max(0.0, longest - shortest);
    const double most = std::clamp(0.25 * budget_, 1.0, double{most_bins});
    const bool usual = span / delay_bin_m < most - 1.0;
    const double width = usual ? delay_bin_m : span / most;
    // Bins of the usual width begin where those of every link do.
    const double origin = usual ? delay_bin_m * std::floor(shortest / delay_bin_m) : shortest;
    const auto last = static_cast<uint32_t>(most) - 1;
    bins_.assign(size_t{last} + 1, {});
    for (Cell& cell : cells_) {
      const double number = (cell.length_m - origin) / width;  // NaN if all have one length
      cell.bin = number > 0.0 ? static_cast<uint32_t>(std::min<double>(last, number)) : 0;
      bins_[cell.bin].power += cell.power;
      ++bins_[cell.bin].cells;
    }
    for (Bin& bin : bins_) bin.weight = std::cbrt(bin.power * bin.power);
    share_budget();
  }

  /// Gives every bin a draw, and the rest by weight. A bin with a draw for each cell leaves the rest of its
  /// share to the others.
  void share_budget() {
    uint32_t left = budget_;
    for (Bin& bin : bins_)
      if (bin.cells > 0) bin.draws = 1, --left;
    for (int round = 0; round < 4 && left > 0; ++round) {
      double weights = 0.0;
      for (const Bin& bin : bins_)
        if (bin.draws < bin.cells) weights += bin.weight;
      if (weights == 0.0) return;
      const double share = left / weights;
      for (Bin& bin : bins_) {
        if (bin.draws >= bin.cells) continue;
        const auto more = static_cast<uint32_t>(share * bin.weight);
        const uint32_t taken = std::min({more, bin.cells - bin.draws, left});
        bin.draws += taken, left -= taken;
      }
    }
  }

  void add_draw(const Cell& cell, double stratum_power, bool alone) {
    draws_.push_back({cell.index, stratum_power / cell.power * cell.factor, alone ? 0 : ++strata_});
  }

  /// Draws `count` of the cells of a bin.
  void draw_bin(std::vector<uint32_t>& cells, uint32_t count) {
    double power = take_large_ones(cells, count);
    if (cells.empty()) return;
    const double stratum = power / count;
    double before = 0.0;
    const auto number_of = [&](const Cell& cell) {
      return std::min(count - 1.0, std::floor((before + 0.5 * cell.power) / stratum));
    };
    for (size_t first = 0, last = 0; first < cells.size(); first = last) {
      const double number = number_of(cells_[cells[first]]);
      const Cell* winner = nullptr;
      double sum = 0.0;
      for (last = first; last < cells.size() && number_of(cells_[cells[last]]) == number; ++last) {
        const Cell& cell = cells_[cells[last]];
        before += cell.power, sum += cell.power;
        if (winner == nullptr || cell.clock < winner->clock) winner = &cell;
      }
      add_draw(*winner, sum, last - first == 1 && !winner->divisible);
    }
  }

  /// Lets single scatterings with the power of a stratum or more stand for themselves. Without them the
  /// strata of the others have less. At least one draw is left if a cell is. Returns the power that is left.
  double take_large_ones(std::vector<uint32_t>& cells, uint32_t& count) {
    for (;;) {
      double power = 0.0;
      for (const uint32_t i : cells) power += cells_[i].power;
      const double stratum = power / count;
      std::vector<uint32_t> small;
      size_t looked_at = 0;
      for (const uint32_t i : cells) {
        const bool others = ++looked_at < cells.size() || !small.empty();
        const Cell& cell = cells_[i];
        if (cell.divisible || cell.power < stratum || (others && count == 1)) {
          small.push_back(i);
          continue;
        }
        add_draw(cell, cell.power, true);
        --count;
      }
      const bool done = small.size() == cells.size();
      cells = std::move(small);
      if (done || cells.empty()) return power;
    }
  }

  const ScatterTree& tree_;
  dvec3 target_;
  uint32_t budget_;
  uint32_t strata_ = 0;
  std::vector<Cell> cells_;  ///< in the order of the tree, and of the single scatterings
  std::vector<Bin> bins_;
  std::vector<ScatterDraw> draws_;
};

}  // namespace

std::vector<ScatterDraw> draw_scatterings(const ScatterTree& tree, const dvec3& target,
                                          std::span<const SingleScattering> singles, uint32_t budget,
                                          const Sight& sight) {
  GREATX_CHECK(budget > 0, "a budget of {}", budget);
  const size_t count = tree.patches().size() + singles.size();
  if (count > budget) return Strata(tree, target, singles, budget, sight).draw();
  std::vector<ScatterDraw> draws;
  for (uint32_t i = 0; i < count; ++i) draws.push_back({.index = i});
  return draws;
}

}  // namespace greatx::rf
