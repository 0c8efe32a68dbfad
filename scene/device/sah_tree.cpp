// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/device/sah_tree.h"

#include <algorithm>
#include <bit>
#include <numeric>
#include <span>

#include "core/parallel.h"
#include "shaders/shared/tree.h"

namespace greatx::scene {
namespace {

constexpr int bin_count = 16;
/// A leaf with more triangles is split in any case. One with fewer is split where that is cheaper than
/// testing all of them.
constexpr uint32_t most_in_leaf = 4;
static_assert(most_in_leaf <= shared::tree_most_in_leaf);

struct Split {
  double cost = std::numeric_limits<double>::infinity();
  int axis = -1;
  int last_left = 0;  ///< bin
};

/// Makes the tree. Parts of the order that do not overlap are divided at the same time: first level by level,
/// then whole subtrees, once there are many. The nodes are in the order in which one thread visits them, so
/// the number of threads changes nothing.
class Builder {
 public:
  explicit Builder(std::vector<TreeTriangle> triangles)
      : triangles_(std::move(triangles)), order_(triangles_.size()) {
    for (const TreeTriangle& triangle : triangles_) {
      TreeBox box;
      for (const vec3& corner : triangle.corners) box.add(corner);
      boxes_.push_back(box);
      centers_.push_back(box.center());
    }
    std::iota(order_.begin(), order_.end(), 0u);
    if (order_.empty()) return;
    build_top();
    nodes_.reserve(2 * order_.size());
    append(0);
  }

  SahTree take() {
    SahTree tree{std::move(nodes_), {}, depth_, 0};
    tree.triangles.reserve(order_.size());
    for (const uint32_t triangle : order_) tree.triangles.push_back(triangles_[triangle]);
    for (const SahTree::Node& node : tree.nodes) tree.inner_nodes += node.count == 0 ? 1 : 0;
    return tree;
  }

 private:
  /// A subtree with indices of its own.
  struct Part {
    std::vector<SahTree::Node> nodes;
    uint32_t depth = 0;  ///< levels below the root of the tree
  };
  /// A node above the parts, or a part.
  struct TopNode {
    uint32_t first = 0, count = 0, level = 0;
    SahTree::Node node;
    uint32_t in_left = 0;        ///< 0: a part
    size_t left = 0, right = 0;  ///< places in top_
    Part part;
  };

  void build_top() {
    // Small subtrees are one piece of work. Their size depends on the scene alone, and so does the work.
    const uint32_t whole = std::max<uint32_t>(1024, static_cast<uint32_t>(order_.size() / 256));
    top_.push_back({0, static_cast<uint32_t>(order_.size())});
    for (size_t begin = 0; begin < top_.size();) {
      const size_t end = top_.size();
      parallel_for(end - begin, 0, [&](size_t i) {
        TopNode& top = top_[begin + i];
        if (top.count <= whole)
          build(top.part, top.first, top.count, top.level);
        else
          top.in_left = divide_node(top.first, top.count, top.level, top.node);
      });
      for (; begin < end; ++begin) {
        const uint32_t first = top_[begin].first, count = top_[begin].count, level = top_[begin].level + 1,
                       in_left = top_[begin].in_left;
        if (in_left == 0) continue;
        top_[begin].left = top_.size();
        top_[begin].right = top_.size() + 1;
        top_.push_back({first, in_left, level});
        top_.push_back({first + in_left, count - in_left, level});
      }
    }
  }

  /// Appends a node of top_ and what is below it. Returns its index.
  uint32_t append(size_t place) {
    const TopNode& top = top_[place];
    const auto me = static_cast<uint32_t>(nodes_.size());
    if (top.in_left == 0) {
      depth_ = std::max(depth_, top.part.depth);
      for (SahTree::Node node : top.part.nodes) {
        node.left += me;
        node.right += me;
        nodes_.push_back(node);
      }
      return me;
    }
    depth_ = std::max(depth_, top.level + 1);
    nodes_.push_back(top.node);
    const uint32_t left = append(top.left), right = append(top.right);
    make_inner(nodes_[me], left, right);
    return me;
  }

  /// Appends a subtree. Returns its index.
  uint32_t build(Part& part, uint32_t first, uint32_t count, uint32_t level) {
    const auto me = static_cast<uint32_t>(part.nodes.size());
    part.nodes.emplace_back();
    const uint32_t in_left = divide_node(first, count, level, part.nodes[me]);
    if (in_left == 0) return me;
    part.depth = std::max(part.depth, level + 1);
    const uint32_t left = build(part, first, in_left, level + 1),
                   right = build(part, first + in_left, count - in_left, level + 1);
    make_inner(part.nodes[me], left, right);
    return me;
  }

  static void make_inner(SahTree::Node& node, uint32_t left, uint32_t right) {
    node.count = 0;
    node.left = left;
    node.right = right;
  }

  /// Fills a node, and divides its triangles if that pays. Returns how many are in the left child; 0: it is a
  /// leaf.
  uint32_t divide_node(uint32_t first, uint32_t count, uint32_t level, SahTree::Node& node) {
    TreeBox centers;
    for (const uint32_t leaf : std::span(order_).subspan(first, count)) {
      node.box.add(boxes_[leaf]);
      centers.add(centers_[leaf]);
    }
    node.first = first;
    node.count = count;
    if (count == 1) return 0;
    const Split split = best_split(first, count, centers);
    const double area = node.box.area();
    if (count <= most_in_leaf && split.cost + area >= area * count) return 0;
    return divide(first, count, level, centers, split);
  }

  /// Holds the bins along an axis on which the centres are not all equal.
  struct Bins {
    double low, per_length;
    Bins(const TreeBox& centers, int axis)
        : low(centers.min[axis]), per_length(bin_count / (static_cast<double>(centers.max[axis]) - low)) {}
    int of(float center) const {
      return std::min(bin_count - 1, static_cast<int>((static_cast<double>(center) - low) * per_length));
    }
  };

  /// Minimises the sum over both sides of area times triangles. The split has no axis if all centres are one
  /// point.
  Split best_split(uint32_t first, uint32_t count, const TreeBox& centers) const {
    Split best;
    for (int axis = 0; axis < 3; ++axis) {
      if (!(centers.max[axis] > centers.min[axis])) continue;
      const Bins bins(centers, axis);
      std::array<TreeBox, bin_count> boxes;
      std::array<uint32_t, bin_count> counts{};
      for (const uint32_t leaf : std::span(order_).subspan(first, count)) {
        const size_t bin = static_cast<size_t>(bins.of(centers_[leaf][axis]));
        boxes[bin].add(boxes_[leaf]);
        ++counts[bin];
      }
      std::array<double, bin_count> right_cost{};  // cost of the bins from this one on
      TreeBox right;
      uint32_t in_right = 0;
      for (size_t bin = bin_count - 1; bin > 0; --bin) {
        right.add(boxes[bin]);
        in_right += counts[bin];
        right_cost[bin] = right.area() * in_right;
      }
      TreeBox left;
      uint32_t in_left = 0;
      for (size_t bin = 0; bin + 1 < bin_count; ++bin) {
        left.add(boxes[bin]);
        in_left += counts[bin];
        const double cost = left.area() * in_left + right_cost[bin + 1];
        if (in_left > 0 && in_left < count && cost < best.cost) best = {cost, axis, static_cast<int>(bin)};
      }
    }
    return best;
  }

  /// Moves the triangles of the left side to the front and returns their number. Divides in the middle if the
  /// split has no axis, or if only halving can still keep the depth of the tree within its limit.
  uint32_t divide(uint32_t first, uint32_t count, uint32_t level, const TreeBox& centers,
                  const Split& split) {
    const auto begin = order_.begin() + first, end = begin + count;
    if (split.axis >= 0 && level + static_cast<uint32_t>(std::bit_width(count)) < shared::tree_most_depth) {
      const Bins bins(centers, split.axis);
      const auto middle = std::stable_partition(
          begin, end, [&](uint32_t leaf) { return bins.of(centers_[leaf][split.axis]) <= split.last_left; });
      return static_cast<uint32_t>(middle - begin);
    }
    const int axis = std::max(split.axis, 0);
    std::nth_element(begin, begin + count / 2, end, [&](uint32_t a, uint32_t b) {
      return std::pair(centers_[a][axis], a) < std::pair(centers_[b][axis], b);
    });
    return count / 2;
  }

  std::vector<TreeTriangle> triangles_;
  std::vector<TreeBox> boxes_;
  std::vector<vec3> centers_;
  std::vector<uint32_t> order_;
  std::vector<TopNode> top_;
  std::vector<SahTree::Node> nodes_;
  uint32_t depth_ = 0;
};

}  // namespace

SahTree make_sah_tree(std::vector<TreeTriangle> triangles) { return Builder(std::move(triangles)).take(); }

}  // namespace greatx::scene
