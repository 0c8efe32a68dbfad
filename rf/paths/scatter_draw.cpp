// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/paths/scatter_draw.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/error.h"
#include "core/random.h"

namespace greatx::rf {

namespace {

/// Cells for each draw: with more of them, the strata follow delay and place more closely.
constexpr double cells_of_draw = 8.0;
constexpr uint32_t most_bins = 4096;
/// Cells for each view of the target, in addition.
constexpr double cells_of_view = 4.0;
/// Cells that are asked for their sight first, and, if not enough of the power is seen, those for each draw.
constexpr double first_probes = 128.0, probes_of_draw = 0.25, enough_seen = 0.5;
/// A cell whose middle is hidden may hold patches that are not. It is drawn as if this share of its power
/// arrived.
constexpr double least_sight = 0.1;
/// A cell over reflections is asked for its sight if it has this part of the power of a probe.
constexpr double looked_at_over_reflections = 0.125;

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
  uint32_t view = 0;  ///< as ScatterDraw::view
  double race = 0.0;  ///< of a cell over reflections: when its clock runs out, in units of 1/Node::power
  /// Of a cell over reflections: how far the power of one of its patches may exceed what is expected of it.
  double spread = 1.0;
  double variance = 0.0;  ///< estimate, of the power of what is drawn for the cell
};

/// Holds how the children of a node share its clock in a view.
struct Race {
  bool first_wins = false;
  double behind = 0.0;  ///< of the other child after the winner, in units of 1/power
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
         uint32_t budget, const Sight& sight, const ReflectedTarget* views = nullptr)
      : tree_(tree), target_(target), views_(views), budget_(budget) {
    if (!tree.empty()) add_roots();
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
    open_to(cells_of_draw * budget_, cells_of_view);
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
  void add_roots() {
    add(cells_, 0, {});
    for (uint32_t view = 0; views_ != nullptr && view < views_->size(); ++view) {
      const double clock = -std::log(1.0 - RandomStream(views_->key(view), 0).uniform());
      add(cells_, 0, {.view = view + 1, .race = clock / tree_.nodes()[0].power});
    }
  }

  /// Returns where a view has the target.
  const dvec3& place(uint32_t view) const { return view == 0 ? target_ : views_->image(view - 1); }

  double power_over(const ScatterTree::Node& node, uint32_t view) const {
    if (view == 0) return tree_.to(node, target_);
    if (views_->misses(view - 1, node)) return 0.0;
    const double power = tree_.to(node, views_->image(view - 1));
    return power > 0.0 ? power * views_->share(view - 1, node.center) : 0.0;
  }

  /// Appends a node, unless it sends nothing. View, sight and race are those of `from`.
  void add(std::vector<Cell>& cells, uint32_t index, const Cell& from) const {
    const ScatterTree::Node& node = tree_.nodes()[index];
    const double power = from.sight * power_over(node, from.view);
    if (!(power > 0.0)) return;
    cells.push_back({.node = index,
                     .index = node.drawn,
                     .power = power,
                     .length_m = node.length_m + glm::length(place(from.view) - node.center),
                     .sight = from.sight,
                     .divisible = node.second != ScatterTree::none,
                     .view = from.view,
                     .race = from.race,
                     .spread = from.view > 0 ? spread_of(node, from.view) : 1.0});
  }

  /// Patches may be much nearer to an image than the middle of a wide node, down to the distance of the image
  /// from its mirror.
  double spread_of(const ScatterTree::Node& node, uint32_t view) const {
    const double away_m = glm::length(place(view) - node.middle) - node.radius_m;
    return 1.0 + node.radius_m / std::max({away_m, views_->behind_m(view - 1), 1e-3});
  }

  /// The straight view draws by the clocks of the patches. Another view needs clocks of its own, independent
  /// of them. They are drawn from the root down: a child has the clock of its parent with the probability of
  /// its share of the power, and the other one runs longer, since a clock has no memory. Hence it does not
  /// matter which nodes are opened. The draw of a node belongs to the patch that the clocks name for it.
  Race race(const ScatterTree::Node& node, const ScatterTree::Node& a, const ScatterTree::Node& b,
            uint32_t view) const {
    const uint64_t clock = std::bit_cast<uint64_t>(tree_.patches()[node.drawn].clock);
    RandomStream random(views_->key(view - 1) ^ clock, node.last - node.first, 1);
    const bool first = random.uniform() * (a.power + b.power) < a.power;
    return {first, -std::log(1.0 - random.uniform()) / (first ? b.power : a.power)};
  }

  void open_cell(const Cell& cell, std::vector<Cell>& next) const {
    const ScatterTree::Node& node = tree_.nodes()[cell.node];
    Cell first = cell, second = cell;
    if (cell.view > 0) {
      const Race result = race(node, tree_.nodes()[cell.node + 1], tree_.nodes()[node.second], cell.view);
      (result.first_wins ? second : first).race += result.behind;
    }
    add(next, cell.node + 1, first);
    add(next, node.second, second);
  }

  /// Returns the patch that a view draws for a node.
  uint32_t drawn_over(uint32_t index, uint32_t view) const {
    for (;;) {
      const ScatterTree::Node& node = tree_.nodes()[index];
      if (node.second == ScatterTree::none) return node.first;
      const bool first = race(node, tree_.nodes()[index + 1], tree_.nodes()[node.second], view).first_wins;
      index = first ? index + 1 : node.second;
    }
  }

  /// Estimates the variance of what is drawn for two neighbours: only one patch of each is looked at, and it
  /// may not reach the target. Their powers stand to what was expected of them in two ratios. If these are
  /// two draws of one distribution, half of the square of their difference has its variance as its mean
  /// (collapsed strata; Cochran, 5A.12). If they are not, the estimate is too large.
  static void estimate_variance(Cell& a, double expected_a, Cell& b, double expected_b) {
    const double apart = a.power / expected_a - b.power / expected_b;
    const double variance = 0.5 * (expected_a * expected_a + expected_b * expected_b) * apart * apart;
    if (a.power > 0.0) a.variance = b.power > 0.0 ? 0.5 * variance : variance;
    if (b.power > 0.0) b.variance = a.power > 0.0 ? 0.5 * variance : variance;
  }

  /// Gives each cell the delay of the patch that is drawn for it, and the power that this patch would have
  /// for it. Which patch of a node that is does not depend on when the node's clock runs out, so that the
  /// race of the cells stays fair. Whether a node is opened must not depend on it.
  void settle_cells() {
    GeometricPath way;
    Cell* unpaired = nullptr;
    double expected_of_unpaired = 0.0;
    for (Cell& cell : cells_) {
      if (cell.node == ScatterTree::none) continue;
      const double expected = cell.power;
      const ScatterTree::Node& node = tree_.nodes()[cell.node];
      if (cell.view > 0) cell.index = drawn_over(cell.node, cell.view);
      const LitPatch& drawn = tree_.patches()[cell.index];
      const dvec3 to = place(cell.view) - drawn.position;
      const double distance_m = glm::length(to);
      cell.factor = node.power / drawn.power;
      cell.power = distance_m > 0.0
                       ? cell.sight * cell.factor * scattered_power(drawn, to / distance_m, distance_m)
                       : 0.0;
      if (cell.view > 0 && cell.power > 0.0)
        cell.power *=
            views_->reach(cell.view - 1, drawn, way) ? views_->share(cell.view - 1, drawn.position) : 0.0;
      cell.length_m = drawn.length_m + distance_m;
      cell.clock = (cell.view > 0 ? cell.race : node.clock) * node.power / cell.power;
      if (cell.view == 0 || !cell.divisible) continue;
      if (unpaired != nullptr) estimate_variance(*unpaired, expected_of_unpaired, cell, expected);
      unpaired = unpaired == nullptr ? &cell : nullptr;
      expected_of_unpaired = expected;
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
      open_cell(cell, next);
      opened = true;
    }
    cells_ = std::move(next);
    return opened;
  }

  /// Finds out roughly what is hidden from the target.
  void look_around(const Sight& sight) {
    for (const double probes : {first_probes, probes_of_draw * budget_}) {
      open_to(probes);
      double total = 0.0, before = 0.0, after = 0.0;
      for (const Cell& cell : cells_) total += cell.power;
      for (Cell& cell : cells_) {
        before += cell.power / cell.sight;
        if (cell.view == 0 || cell.power > looked_at_over_reflections * total / probes) look(cell, sight);
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
        std::max(least_sight, sight(tree_.patches()[node.first + (node.last - node.first) / 2], cell.view));
    cell.power *= seen / cell.sight;
    cell.sight = seen;
  }

  /// Opens nodes until none has more than a small part of the power. Their number does not depend on that of
  /// the patches. What is sent straight is opened as if it were alone, since what a view sends is not well
  /// known before its nodes are opened.
  void open_to(double cells, double of_each_view = 0.0) {
    const double views = views_ == nullptr ? 0.0 : views_->size();
    double of_straight = 0.0, of_views = 0.0;
    do {
      double straight = 0.0, all = 0.0;
      for (const Cell& cell : cells_) (cell.view == 0 ? straight : all) += cell.power;
      all += straight;
      of_straight = straight / cells;
      of_views = all / (cells + of_each_view * views);
    } while (open([&](const Cell& cell) {
      return cell.power * cell.spread > (cell.view == 0 ? of_straight : of_views);
    }));
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

  void add_draw(const Cell& cell, double stratum_power, double variance, bool alone) {
    draws_.push_back({cell.index, stratum_power / cell.power * cell.factor, alone ? 0 : ++strata_, cell.view,
                      variance / (stratum_power * stratum_power)});
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
      double sum = 0.0, variance = 0.0;
      for (last = first; last < cells.size() && number_of(cells_[cells[last]]) == number; ++last) {
        const Cell& cell = cells_[cells[last]];
        before += cell.power, sum += cell.power, variance += cell.variance;
        if (winner == nullptr || cell.clock < winner->clock) winner = &cell;
      }
      add_draw(*winner, sum, variance, last - first == 1 && !winner->divisible);
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
        add_draw(cell, cell.power, 0.0, true);
        --count;
      }
      const bool done = small.size() == cells.size();
      cells = std::move(small);
      if (done || cells.empty()) return power;
    }
  }

  const ScatterTree& tree_;
  dvec3 target_;
  const ReflectedTarget* views_;  ///< null: patches send straight alone
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

std::vector<ScatterDraw> draw_scatterings(const ScatterTree& tree, const dvec3& target,
                                          const ReflectedTarget& views, uint32_t budget, const Sight& sight) {
  GREATX_CHECK(budget > 0, "a budget of {}", budget);
  return Strata(tree, target, {}, budget, sight, &views).draw();
}

}  // namespace greatx::rf
