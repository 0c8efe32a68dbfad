// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/device/scene_trees.h"

#include <algorithm>

#include "core/activity.h"
#include "core/error.h"
#include "scene/device/sah_tree.h"
#include "scene/device/tree_words.h"

namespace greatx::scene {
namespace {

bool has_area(const std::array<vec3, 3>& corners) {
  const dvec3 a(corners[0]), b(corners[1]), c(corners[2]);
  return glm::cross(b - a, c - a) != dvec3(0.0);
}

std::vector<TreeTriangle> triangles_of(const Scene& scene, const Body& body) {
  std::vector<TreeTriangle> triangles;
  const auto corner = [&](uint32_t i) { return scene.positions[scene.indices[i]]; };
  for (uint32_t p = body.first_primitive; p < body.first_primitive + body.primitive_count; ++p) {
    const Primitive& primitive = scene.primitives[p];
    for (uint32_t i = primitive.first_index; i < primitive.first_index + primitive.index_count; i += 3)
      if (const std::array corners{corner(i), corner(i + 1), corner(i + 2)}; has_area(corners))
        triangles.push_back({corners, i / 3, p});
  }
  return triangles;
}

/// Writes the tree of a body, its nodes from `first_node` on and its triangles from `first_triangle` on.
void write_tree(TreeWriter& writer, const Scene& scene, uint32_t body, const SahTree& tree, size_t first_node,
                size_t first_triangle) {
  std::vector<uint32_t> references;
  references.reserve(tree.nodes.size());
  size_t next = first_node;
  for (const SahTree::Node& node : tree.nodes) {
    const bool inner = node.count == 0;
    references.push_back(static_cast<uint32_t>(inner ? next : first_triangle + 3 * size_t{node.first}) |
                         (inner ? 0u : shared::tree_leaf | node.count << shared::tree_count_shift));
    if (inner) next += 2;
  }
  const TreeFrame frame(tree.nodes.empty() ? TreeBox{} : tree.nodes[0].box);
  writer.put(2 * size_t{body}, frame.low(), references.empty() ? shared::tree_none : references[0]);
  writer.put(2 * size_t{body} + 1, frame.step(), scene.owner_of(body));
  for (size_t i = 0; i < tree.nodes.size(); ++i) {
    if (tree.nodes[i].count != 0) continue;
    size_t quad = references[i];
    for (const uint32_t child : {tree.nodes[i].left, tree.nodes[i].right})
      writer.put_child(quad++, frame, tree.nodes[child].box, references[child]);
  }
  for (size_t i = 0; i < tree.triangles.size(); ++i) {
    const TreeTriangle& triangle = tree.triangles[i];
    const bool masked =
        scene.materials[scene.primitives[triangle.primitive].material].pbr.alpha_mode != AlphaMode::opaque;
    const size_t quad = first_triangle + 3 * i;
    writer.put(quad, triangle.corners[0], triangle.triangle);
    writer.put(quad + 1, triangle.corners[1], triangle.primitive | (masked ? shared::tree_masked : 0u));
    writer.put(quad + 2, triangle.corners[2], scene.facet_of_triangle[triangle.triangle]);
  }
}

}  // namespace

SceneTrees make_scene_trees(const Scene& scene) {
  const Activity activity("building the trees of triangles");
  SceneTrees trees;
  std::vector<SahTree> of_bodies;
  for (const Body& body : scene.bodies) {
    const SahTree& tree = of_bodies.emplace_back(make_sah_tree(triangles_of(scene, body)));
    trees.triangles += static_cast<uint32_t>(tree.triangles.size());
    trees.inner_nodes += tree.inner_nodes;
    trees.leaves += static_cast<uint32_t>(tree.nodes.size()) - tree.inner_nodes;
    trees.depth = std::max(trees.depth, tree.depth);
  }
  size_t node = 2 * scene.bodies.size(), triangle = node + 2 * size_t{trees.inner_nodes};
  const size_t quads = triangle + 3 * size_t{trees.triangles};
  if (quads >= shared::tree_most_quads)
    throw_user_error("a scene of {} triangles: expected at most about {} for tracing by greatx's own trees",
                     trees.triangles, shared::tree_most_quads / 4);
  trees.words.resize(4 * quads);
  TreeWriter writer(trees.words);
  for (uint32_t body = 0; body < of_bodies.size(); ++body) {
    write_tree(writer, scene, body, of_bodies[body], node, triangle);
    node += 2 * size_t{of_bodies[body].inner_nodes};
    triangle += 3 * of_bodies[body].triangles.size();
  }
  return trees;
}

}  // namespace greatx::scene
