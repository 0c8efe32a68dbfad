// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/check/check.h"

#include <algorithm>

#include "core/activity.h"
#include "scene/check/inside_rays.h"
#include "scene/check/model_materials.h"
#include "scene/check/openings.h"
#include "scene/check/orientation.h"
#include "scene/check/overlaps.h"
#include "scene/check/sizes.h"

namespace greatx::scene {

uint64_t SceneFaults::count(FaultSeverity severity) const {
  uint64_t sum = 0;
  for (const SceneFault& fault : faults)
    if (fault.severity == severity) sum += fault.count;
  return sum;
}

const SceneFault* SceneFaults::find(const std::string& kind) const {
  const auto found = std::ranges::find(faults, kind, &SceneFault::kind);
  return found == faults.end() ? nullptr : &*found;
}

SceneFaults check_scene(const Model& model, const CheckOptions& options) {
  using namespace check;
  const Activity activity("checking a scene");
  SceneFaults result;
  CheckFigures& figures = result.figures;
  FaultList list;
  const Soup soup = make_soup(model, list);
  const SoupTree tree(soup);
  Topology topology = make_topology(soup, options.weld_m);
  const Closing closing = close_by_others(soup, topology, tree, options, list);
  find_openings(soup, topology, tree, options, list);
  find_wrong_sides(soup, topology, list);
  find_wrong_normals(model, list);
  const RayCount rays = find_leaks_by_rays(soup, topology, closing, tree, options, list);
  figures.crowds = closing.crowds + find_overlaps(soup, tree, options, list);
  figures.facets = find_small_faces(soup, topology, options, list);
  find_strange_sizes(soup, options, list);

  std::vector<double> areas(model.materials.size());
  for (size_t t = 0; t < soup.triangles.size(); ++t) areas[soup.material[t]] += soup.areas[t];
  result.faults = list.finish(model, options.most_places);
  for (SceneFault& fault : find_material_faults(model, areas, options.radio))
    result.faults.push_back(std::move(fault));
  std::ranges::stable_sort(result.faults, std::greater{}, &SceneFault::severity);

  figures.objects = model.instances.size();
  figures.triangles = soup.triangles.size();
  figures.materials = model.materials.size();
  for (const Part& part : topology.parts)
    ++(part.kind == PartKind::closed          ? figures.closed_parts
       : part.kind == PartKind::nearly_closed ? figures.nearly_closed_parts
                                              : figures.sheets);
  figures.open_edges = topology.open_edges.size();
  figures.closed_by_others = static_cast<uint64_t>(
      std::ranges::count_if(topology.open_edges, [](const OpenEdge& edge) { return edge.closed; }));
  figures.rays = rays.rays, figures.rays_out = rays.out;
  figures.bounds = soup.bounds;
  return result;
}

}  // namespace greatx::scene
