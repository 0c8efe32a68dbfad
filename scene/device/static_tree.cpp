// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/device/static_tree.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>

#include "core/activity.h"
#include "core/error.h"
#include "core/parallel.h"
#include "shaders/shared/tree.h"

namespace greatx::scene {
namespace {

constexpr int bin_count = 16;
/// A leaf with more triangles is split in any case. One with fewer is split where that is cheaper than
/// testing all of them.
constexpr uint32_t most_in_leaf = 4;
static_assert(most_in_leaf <= shared::tree_most_in_leaf);

struct Box {
  vec3 min{std::numeric_limits<float>::infinity()}, max{-std::numeric_limits<float>::infinity()};
  void add(const vec3& point) {
    min = glm::min(min, point);
    max = glm::max(max, point);
  }
  void add(const Box& other) {
    min = glm::min(min, other.min);
    max = glm::max(max, other.max);
  }
  vec3 center() const { return 0.5f * min + 0.5f * max; }
  /// Returns half of the surface, in fp64 so that no scene overflows it.
  double area() const {
    if (min.x > max.x) return 0.0;
    const dvec3 size = dvec3(max) - dvec3(min);
    return size.x * size.y + size.y * size.z + size.z * size.x;
  }
};

struct Leaf {
  std::array<vec3, 3> corners;
  uint32_t triangle, primitive;
};

struct TreeNode {
  Box box;
  uint32_t first = 0, count = 0;  ///< count 0: an inner node, its children at `left` and `right`
  uint32_t left = 0, right = 0;
};

struct Split {
  double cost = std::numeric_limits<double>::infinity();
  int axis = -1;
  int last_left = 0;  ///< bin
};

std::array<vec3, 3> corners_of(const Scene& scene, uint32_t first_index) {
  const auto corner = [&](uint32_t i) { return scene.positions[scene.indices[first_index + i]]; };
  return {corner(0), corner(1), corner(2)};
}

bool has_area(const std::array<vec3, 3>& corners) {
  const dvec3 a(corners[0]), b(corners[1]), c(corners[2]);
  return glm::cross(b - a, c - a) != dvec3(0.0);
}

template <typename Function>
void for_triangles(const Scene& scene, const Body& body, const Function& function) {
  for (uint32_t p = body.first_primitive; p < body.first_primitive + body.primitive_count; ++p) {
    const Primitive& primitive = scene.primitives[p];
    for (uint32_t i = primitive.first_index; i < primitive.first_index + primitive.index_count; i += 3)
      function(corners_of(scene, i), i / 3, p);
  }
}

/// Makes the tree. Parts of the order that do not overlap are divided at the same time: first level by level,
/// then whole subtrees, once there are many. The nodes are in the order in which one thread visits them, so
/// the number of threads changes nothing.
class Builder {
 public:
  explicit Builder(std::vector<Leaf> leaves) : leaves_(std::move(leaves)), order_(leaves_.size()) {
    for (const Leaf& leaf : leaves_) {
      Box box;
      for (const vec3& corner : leaf.corners) box.add(corner);
      boxes_.push_back(box);
      centers_.push_back(box.center());
    }
    std::iota(order_.begin(), order_.end(), 0u);
    if (order_.empty()) return;
    build_top();
    nodes_.reserve(2 * order_.size());
    append(0);
  }

  const std::vector<TreeNode>& nodes() const { return nodes_; }
  const Leaf& leaf(uint32_t place) const { return leaves_[order_[place]]; }
  uint32_t depth() const { return depth_; }

 private:
  /// A subtree with indices of its own.
  struct Part {
    std::vector<TreeNode> nodes;
    uint32_t depth = 0;  ///< levels below the root of the tree
  };
  /// A node above the parts, or a part.
  struct TopNode {
    uint32_t first = 0, count = 0, level = 0;
    TreeNode node;
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
      for (TreeNode node : top.part.nodes) {
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

  static void make_inner(TreeNode& node, uint32_t left, uint32_t right) {
    node.count = 0;
    node.left = left;
    node.right = right;
  }

  /// Fills a node, and divides its triangles if that pays. Returns how many are in the left child; 0: it is a
  /// leaf.
  uint32_t divide_node(uint32_t first, uint32_t count, uint32_t level, TreeNode& node) {
    Box centers;
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
    Bins(const Box& centers, int axis)
        : low(centers.min[axis]), per_length(bin_count / (static_cast<double>(centers.max[axis]) - low)) {}
    int of(float center) const {
      return std::min(bin_count - 1, static_cast<int>((static_cast<double>(center) - low) * per_length));
    }
  };

  /// Minimises the sum over both sides of area times triangles. The split has no axis if all centres are one
  /// point.
  Split best_split(uint32_t first, uint32_t count, const Box& centers) const {
    Split best;
    for (int axis = 0; axis < 3; ++axis) {
      if (!(centers.max[axis] > centers.min[axis])) continue;
      const Bins bins(centers, axis);
      std::array<Box, bin_count> boxes;
      std::array<uint32_t, bin_count> counts{};
      for (const uint32_t leaf : std::span(order_).subspan(first, count)) {
        const size_t bin = static_cast<size_t>(bins.of(centers_[leaf][axis]));
        boxes[bin].add(boxes_[leaf]);
        ++counts[bin];
      }
      std::array<double, bin_count> right_cost{};  // cost of the bins from this one on
      Box right;
      uint32_t in_right = 0;
      for (size_t bin = bin_count - 1; bin > 0; --bin) {
        right.add(boxes[bin]);
        in_right += counts[bin];
        right_cost[bin] = right.area() * in_right;
      }
      Box left;
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
  uint32_t divide(uint32_t first, uint32_t count, uint32_t level, const Box& centers, const Split& split) {
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

  std::vector<Leaf> leaves_;
  std::vector<Box> boxes_;
  std::vector<vec3> centers_;
  std::vector<uint32_t> order_;
  std::vector<TopNode> top_;
  std::vector<TreeNode> nodes_;
  uint32_t depth_ = 0;
};

/// Holds the grid of the boxes' corners, with the shader's own numbers.
struct Frame {
  vec3 low{0.0f}, step{1.0f};

  explicit Frame(const Box& box) {
    if (box.min.x > box.max.x) return;
    const vec3 reach = glm::max(glm::abs(box.min), glm::abs(box.max));
    // a lower limit for flat worlds
    const float least = std::max({reach.x, reach.y, reach.z, 1.0f}) * 0x1p-20f;
    low = box.min;
    // The step is a little larger than needed, so that the last step lies beyond the box however the division
    // was rounded.
    step = glm::max(box.max - box.min, vec3(least)) * (1.0001f / static_cast<float>(shared::tree_steps));
  }
  uint32_t below(const vec3& point, int axis) const { return whole(std::floor(steps(point, axis))); }
  uint32_t above(const vec3& point, int axis) const { return whole(std::ceil(steps(point, axis))); }

 private:
  double steps(const vec3& point, int axis) const {
    return (static_cast<double>(point[axis]) - low[axis]) / step[axis];
  }
  static uint32_t whole(double steps) {
    GREATX_CHECK(steps >= 0.0 && steps <= shared::tree_steps, "a corner {} steps into the frame", steps);
    return static_cast<uint32_t>(steps);
  }
};

class Writer {
 public:
  explicit Writer(size_t quads) : words_(4 * quads) {}
  void put(size_t quad, const vec3& value, uint32_t last) {
    put(quad, std::bit_cast<uint32_t>(value.x), std::bit_cast<uint32_t>(value.y),
        std::bit_cast<uint32_t>(value.z), last);
  }
  void put(size_t quad, uint32_t x, uint32_t y, uint32_t z, uint32_t w) {
    uint32_t* words = &words_[4 * quad];
    words[0] = x, words[1] = y, words[2] = z, words[3] = w;
  }
  std::vector<uint32_t> take() { return std::move(words_); }

 private:
  std::vector<uint32_t> words_;
};

struct Sphere {
  uint32_t body = 0;
  vec3 center{0.0f};
  float radius = 0.0f;
};

std::vector<Sphere> moving_spheres(const Scene& scene) {
  std::vector<Sphere> spheres;
  for (uint32_t body = 1; body < scene.bodies.size(); ++body) {
    Bounds bounds;
    for_triangles(scene, scene.bodies[body], [&](const std::array<vec3, 3>& corners, uint32_t, uint32_t) {
      for (const vec3& corner : corners) bounds.add(dvec3(corner));
    });
    if (bounds.empty()) continue;
    // The centre is rounded. The radius grows by that error and by its own rounding.
    const vec3 center(bounds.center());
    const double radius = 0.5 * glm::length(bounds.size()) + glm::length(dvec3(center) - bounds.center());
    spheres.push_back({body, center, static_cast<float>(radius * (1.0 + 0x1p-22))});
  }
  return spheres;
}

}  // namespace

StaticTree make_static_tree(const Scene& scene) {
  const Activity activity("building the tree of triangles");
  std::vector<Leaf> leaves;
  for_triangles(scene, scene.bodies[0],
                [&](const std::array<vec3, 3>& corners, uint32_t triangle, uint32_t primitive) {
                  if (has_area(corners)) leaves.push_back({corners, triangle, primitive});
                });
  StaticTree tree;
  tree.triangles = static_cast<uint32_t>(leaves.size());
  const Builder builder(std::move(leaves));
  const std::vector<TreeNode>& nodes = builder.nodes();
  const std::vector<Sphere> spheres = moving_spheres(scene);

  const size_t first_node = shared::tree_bodies + 2 * spheres.size();
  for (const TreeNode& node : nodes) ++(node.count == 0 ? tree.inner_nodes : tree.leaves);
  const size_t first_triangle = first_node + 2 * size_t{tree.inner_nodes};
  const size_t quads = first_triangle + 3 * size_t{tree.triangles};
  GREATX_CHECK(quads < shared::tree_most_quads, "a tree of {} triangles", tree.triangles);
  tree.depth = builder.depth();
  GREATX_CHECK(tree.depth <= shared::tree_most_depth, "a tree {} deep", tree.depth);

  std::vector<uint32_t> references;
  size_t next = first_node;
  for (const TreeNode& node : nodes) {
    references.push_back(
        static_cast<uint32_t>(node.count == 0 ? next : first_triangle + 3 * size_t{node.first}) |
        (node.count == 0 ? 0u : shared::tree_leaf | node.count << shared::tree_count_shift));
    if (node.count == 0) next += 2;
  }

  const Frame frame(nodes.empty() ? Box{} : nodes[0].box);
  Writer writer(quads);
  writer.put(0, frame.low, nodes.empty() ? shared::tree_none : references[0]);
  writer.put(1, frame.step, static_cast<uint32_t>(spheres.size()));
  for (size_t i = 0; i < spheres.size(); ++i) {
    writer.put(shared::tree_bodies + 2 * i, spheres[i].center, std::bit_cast<uint32_t>(spheres[i].radius));
    writer.put(shared::tree_bodies + 2 * i + 1, spheres[i].body, scene.owner_of(spheres[i].body), 0, 0);
  }
  for (size_t i = 0; i < nodes.size(); ++i) {
    if (nodes[i].count != 0) continue;
    size_t quad = references[i];
    for (const uint32_t child : {nodes[i].left, nodes[i].right}) {
      const Box& box = nodes[child].box;
      writer.put(quad++, frame.below(box.min, 0) | frame.below(box.min, 1) << 16,
                 frame.below(box.min, 2) | frame.above(box.max, 0) << 16,
                 frame.above(box.max, 1) | frame.above(box.max, 2) << 16, references[child]);
    }
  }
  for (uint32_t i = 0; i < tree.triangles; ++i) {
    const Leaf& leaf = builder.leaf(i);
    const bool masked =
        scene.materials[scene.primitives[leaf.primitive].material].pbr.alpha_mode != AlphaMode::opaque;
    const size_t quad = first_triangle + 3 * size_t{i};
    writer.put(quad, leaf.corners[0], leaf.triangle);
    writer.put(quad + 1, leaf.corners[1], leaf.primitive | (masked ? shared::tree_masked : 0u));
    writer.put(quad + 2, leaf.corners[2], scene.facet_of_triangle[leaf.triangle]);
  }
  tree.words = writer.take();
  return tree;
}

}  // namespace greatx::scene
