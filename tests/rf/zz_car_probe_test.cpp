// scratch: a car's section at default tubes against fine tubes and brute force
#include <cstdio>
#include <cstdlib>
#include <chrono>
#include "core/parallel.h"
#include "rf/radar/echoes/facet_echoes.h"
#include "scene/generator/generate.h"
#include "scene/gltf/model.h"
#include "scene/build/build.h"

#include "tests/rf/radar_echo_scenes.h"
#include <map>
#include <gtest/gtest.h>
#include "rf/radar/echoes/tube_echoes.h"
#include "rf/radar/echoes/ray_hits.h"
namespace greatx::rf {
namespace {
using namespace rf::testing;
double env(const char* n, double d) { const char* v = std::getenv(n); return v ? std::atof(v) : d; }

struct Probe {
  scene::Model model;
  scene::Scene scene;
  scene::GpuScene gpu;
  Probe(const std::string& kind, const std::string& variant)
      : model(scene::load_model(kind, scene::generate_glb({.kind = kind, .variant = variant}), {})),
        scene(scene::build_scene({{.name = "", .model = &model, .pose = {}}}, {.name = kind})),
        gpu(test::device(), scene, {}) {}
};

Complex total(const EchoList& list, double carrier, uint32_t bounces) {
  Complex sum(0.0);
  for (const Echo& e : list.echoes)
    if (bounces == 0 || e.bounces == bounces)
      sum += e.amplitude * std::polar(1.0, -2.0 * pi * std::remainder(carrier * e.delay.coefficients[0], 1.0));
  return sum;
}

/// single bounce, brute force: triangles divided to sides < h, Gordon on each (linear phase), visible by one ray
Complex brute(const Probe& p, const dvec3& at, double carrier, double h, std::vector<Complex>* per_facet = nullptr) {
  const double lambda = speed_of_light / carrier, k = 2.0 * pi / lambda;
  FacetWorld world(p.scene);
  FacetTrees trees(p.scene);
  EchoTracer tracer(p.scene, trees);
  const auto view = tracer.view(world, 0);
  std::vector<Complex> sums(world.facet_count());
  parallel_for(world.facet_count(), 0, [&](size_t at_f) { const uint32_t f = uint32_t(at_f);
    const PosedFacet& posed = world.facet(f);
    const double side = posed.distance(at);
    if (std::abs(side) < 1e-9) return;
    const dvec3 n = side > 0 ? posed.normal : -posed.normal;
    Complex sum(0.0);
    for (uint32_t t = 0; t < posed.triangle_count; ++t) {
      const auto c = world.corners(f, t);
      const dvec3 u = c[1] - c[0], v = c[2] - c[0];
      const double area = 0.5 * glm::length(glm::cross(u, v));
      const double longest = std::max({glm::length(u), glm::length(v), glm::length(u - v)});
      const int m = std::max(1, int(std::ceil(longest / h)));
      const double small = area / (double(m) * m);
      for (int i = 0; i < m; ++i)
        for (int q = 0; q < 2 * (m - i) - 1; ++q) {
          const bool down = q % 2;
          const double third = (down + 1) / 3.0, b = (i + third) / m, cc = (q / 2 + third) / m;
          const dvec3 point = c[0] + b * u + cc * v;
          const dvec3 from = EchoTracer::lifted(point, n);
          if (!tracer.clear(view, from, at, f)) continue;
          const dvec3 arm = at - point;
          const double r = glm::length(arm);
          // linear phase over the small triangle
          const dvec3 g = 2.0 * k * arm / r;  // gradient of -2kr
          const double s = down ? -1.0 : 1.0;
          const dvec2 e1(glm::dot(posed.axis_u, u), glm::dot(posed.axis_v, u)),
              e2(glm::dot(posed.axis_u, v), glm::dot(posed.axis_v, v));
          const dvec2 a0 = -(s / (3.0 * m)) * (e1 + e2), a1 = a0 + (s / m) * e1, a2 = a0 + (s / m) * e2;
          std::array<dvec2, 3> pts{a0, a1, a2};
          if (cross(a1 - a0, a2 - a0) < 0) std::swap(pts[1], pts[2]);
          const Polygon tri{std::span<const dvec2>(pts)};
          const Complex I = linear_phase_integral(
              tri, dvec2(0.0), dvec2(glm::dot(posed.axis_u, g), glm::dot(posed.axis_v, g)));
          sum += I * std::polar(glm::dot(n, arm) / r / (r * r), -2.0 * k * r);
          (void)small;
        }
    }
    sums[f] = sum;
  });
  Complex all(0.0);
  for (const Complex& s : sums) all += s;
  if (per_facet != nullptr) *per_facet = sums;
  return all;  // times r^2 : sigma = 4 pi |.|^2 r^4/ lambda^2
}

TEST(Probe, Car) {
  const char* kind = std::getenv("KIND") ? std::getenv("KIND") : "car";
  const char* variant = std::getenv("VARIANT") ? std::getenv("VARIANT") : "hatchback";
  const double carrier = env("GHZ", 24) * 1e9, lambda = speed_of_light / carrier;
  const double distance = env("DIST", 57), elevation = radians(env("EL", 15));
  const int aspects = int(env("N", 12));
  const uint32_t bounces = uint32_t(env("B", 1));
  const double h = env("H", 0.005);
  const uint32_t fine = uint32_t(env("FINE", 0));
  Probe p(kind, variant);
  const std::vector<RadioSurface> conductors(p.scene.materials.size(), conductor());
  printf("facets %zu\n", p.scene.facets.size());
  for (int a = 0; a < aspects; ++a) {
    const double az = 2 * pi * (a + env("OFF", 0.0)) / aspects;
    const dvec3 at = dvec3(0, 0, 0.0) + distance * dvec3(std::cos(elevation) * std::cos(az), std::cos(elevation) * std::sin(az), std::sin(elevation));
    const Pose radar = looking(at, dvec3(0, 0, 0.0));
    const auto section = [&](Complex f) { return decibels(std::norm(f) * std::pow(4 * pi, 3) * std::pow(distance, 4) / (lambda * lambda)); };
    EchoOptions options;
    options.max_bounces = bounces;
    options.merge_share = 0.0;
    options.border_floor_m2 = env("FLOOR", 1e-5);
    options.max_echoes = 1u << 24;
    auto run = [&](EchoOptions o) {
      const auto t0 = std::chrono::steady_clock::now();
      EchoFinder finder(p.gpu, RadioSurfaces(conductors, carrier), EchoEnd{}, std::nullopt, o);
      const EchoList list = trace_echoes(finder, p.gpu, p.scene.bodies.size(), at_rest(radar, radar));
      const double s = std::chrono::duration<double>(std::chrono::steady_clock::now() - t0).count();
      std::vector<double> v{s, section(total(list, carrier, 0))};
      for (uint32_t b = 1; b <= bounces; ++b) v.push_back(section(total(list, carrier, b)));
      return v;
    };
    auto show = [](const char* n, const std::vector<double>& v) {
      printf("  %s (%.2fs)", n, v[0]);
      for (size_t i = 1; i < v.size(); ++i) printf(" %7.2f", v[i]);
    };
    printf("%5.1f:", az * 180 / pi);
    show("default", run(options));
    EchoOptions f = options; f.border_floor_m2 = env("FINEFLOOR", 0.0);
    const double half = std::atan(env("HALF", 3.0) / distance), halfz = std::atan(env("HALFZ", 1.6) / distance);
    f.field_of_view = {-half, half, -halfz, halfz};
    for (uint32_t n = fine, i = 0; n > 0 && i < uint32_t(env("LEVELS", 2)); ++i, n *= 4) f.tubes = n, show("fine", run(f));
    if (bounces == 1 && h > 0) {
      for (double hh : {2 * h, h}) {
        const Complex b = brute(p, at, carrier, hh);
        printf("  brute %7.2f", decibels(4 * pi * std::norm(b) * std::pow(distance, 4) / (lambda * lambda)));
      }
    }
    if (std::getenv("SHOW")) {
      std::vector<Complex> b;
      brute(p, at, carrier, h, &b);
      FacetWorld world(p.scene);
      std::vector<Complex> t(world.facet_count());
      std::vector<int> cnt(world.facet_count());
      FacetTrees trees(p.scene);
      EchoTracer tracer(p.scene, trees);
      const RadioSurfaces surfaces(conductors, carrier);
      const EchoEnd ends{}; const TurnedElement end{ends.pattern, std::span(&ends.slant, 1), radar.orientation};
      const EchoField field(world, surfaces, options, end, end, radar.position);
      const RayGrid grid(options, radar);
      const FacetScene fs{world, trees, tracer}; const FacetEchoes small(fs, grid, field, options, radar.position, true, 0, 0);
      const BeamedFacets all = small.choose({});
      printf("\n %zu of %u beamed", all.facets.size(), world.facet_count());
      for (const uint32_t i : all.facets) {
        BeamedFacets one = all;
        one.facets = {i};
        const RawEchoes raw = small.find(one);
        for (const RawEcho& e : raw.echoes) if (i == uint32_t(env("F", -1))) printf("\n  %.4f %.4f %.4f  |%.5f|", e.point.x, e.point.y, e.point.z, std::abs(e.amplitude) / (lambda / std::pow(4 * pi, 1.5) / (distance * distance)));
        for (const RawEcho& e : raw.echoes)
          if (e.bounces == 1) t[i] += e.amplitude * std::polar(1.0, -2.0 * pi * std::remainder(carrier * e.length_m / speed_of_light, 1.0)), ++cnt[i];
      }
      if (env("F", -1) >= 0) {
        const PosedFacet& w = world.facet(uint32_t(env("F", 0)));
        const auto view = tracer.view(world, 0);
        for (int i = 0; i <= 12; ++i) {
          const dvec3 at_point = w.centroid + dvec3(0, 0.1, -0.03 + 0.005 * i);
          const auto met = tracer.first(view, EchoTracer::lifted(at_point, w.normal), glm::normalize(at - at_point), uint32_t(env("F", 0)));
          printf("  z %.4f met %u at %g clear %d\n", at_point.z, met.facet, met.distance, int(tracer.clear(view, EchoTracer::lifted(at_point, w.normal), at, uint32_t(env("F", 0)))));
        }
        for (uint32_t q : {68u, 2u, 4u}) for (uint32_t t = 0; t < world.facet(q).triangle_count; ++t) { const auto c = world.corners(q, t); for (auto& x : c) printf("(%.4f %.4f %.4f) ", x.x, x.y, x.z); printf("of %u\n", q); }
      }
      printf("\n");
      const double to_field = lambda / std::pow(4 * pi, 1.5) / (distance * distance);
      const double to_brute = std::sqrt(4 * pi) * distance * distance / lambda;
      Complex dsum(0.0);
      if (env("F", -1) >= 0) for (uint32_t t = 0; t < world.facet(uint32_t(env("F", 0))).triangle_count; ++t) { const auto c = world.corners(uint32_t(env("F", 0)), t); for (auto& q : c) printf("(%.4f %.4f %.4f) ", q.x, q.y, q.z); printf("\n"); }
      for (uint32_t i = 0; i < world.facet_count(); ++i) {
        const Complex x = t[i] / to_field, y = b[i] * to_brute * Complex(0, -1);
        if (std::abs(x - y) > 0.02 * env("MINDIFF", 1)) {
          const PosedFacet& w = world.facet(i);
          printf("   facet %3u inst %s body %u mat %u n (%.3f %.3f %.3f) size %.2f x %.2f cos %.4f tubes %.4f %.4f (%d)  brute %.4f %.4f c (%.2f %.2f %.2f)\n", i, p.scene.instances[p.scene.facets[i].instance].name.c_str(), w.body, w.material, w.normal.x, w.normal.y, w.normal.z, w.max_u - w.min_u, w.max_v - w.min_v, glm::dot(w.normal, glm::normalize(at - w.centroid)), x.real(), x.imag(), cnt[i], y.real(), y.imag(), w.centroid.x, w.centroid.y, w.centroid.z);
        }
      }
    }
    if (std::getenv("CHAINS")) {
      FacetWorld world(p.scene);
      FacetTrees trees(p.scene);
      EchoTracer tracer(p.scene, trees);
      const RadioSurfaces surfaces(conductors, carrier);
      const EchoEnd ends{}; const TurnedElement end{ends.pattern, std::span(&ends.slant, 1), radar.orientation};
      const EchoField field(world, surfaces, options, end, end, radar.position);
      const RayGrid grid(options, radar);
      const FacetScene fs{world, trees, tracer};
      const FacetEchoes small(fs, grid, field, options, radar.position, true, 0, 0);
      const RawEchoes a = small.find(small.choose({}));
      f.tubes = fine;
      const EchoField field2(world, surfaces, f, end, end, radar.position);
      const RayGrid grid2(f, radar);
      const EchoRays rays{radar.position, radar.position, 0, 0};
      const auto traced = tracer.trace(world, rays, grid2, f.max_bounces, true, [&](uint32_t q) { return field2.reflects(q); }, [&](uint32_t, uint32_t) { return f.max_bounces; }, 0);
      RayHits hits(traced.words, grid2.size());
      hits.find_seen(grid2, world, radar.position, f.max_bounces, 0);
      BeamedFacets nobeams;
      nobeams.marks.assign(world.facet_count(), 0), nobeams.mirrors.assign(world.facet_count(), 0);
      const RawEchoes b = TubeEchoes(grid2, hits, world, trees, field2, p.scene, radar.position, true, f, nullptr, nobeams).find();
      std::map<std::vector<uint32_t>, std::array<Complex, 2>> sums;
      const double to_field = lambda / std::pow(4 * pi, 1.5) / (distance * distance);
      for (int w = 0; w < 2; ++w)
        for (const RawEcho& e : (w == 0 ? a : b).echoes) {
          const RawEchoes& src = w == 0 ? a : b;
          const auto c = src.chain(e);
          sums[std::vector<uint32_t>(c.begin(), c.end())][w] += e.amplitude / to_field * std::polar(1.0, -2.0 * pi * std::remainder(carrier * e.length_m / speed_of_light, 1.0));
        }
      std::vector<std::pair<double, std::vector<uint32_t>>> order;
      for (auto& [c, v] : sums) order.push_back({-std::abs(v[0] - v[1]), c});
      std::sort(order.begin(), order.end());
      printf("\n");
      for (size_t i = 0; i < std::min<size_t>(order.size(), 8); ++i) {
        auto& v = sums[order[i].second];
        printf("   ");
        for (uint32_t q : order[i].second) { const PosedFacet& w = world.facet(q); printf("%u [n %.2f %.2f %.2f, %.2fx%.2f, c %.2f %.2f %.2f] ", q, w.normal.x, w.normal.y, w.normal.z, w.max_u - w.min_u, w.max_v - w.min_v, w.centroid.x, w.centroid.y, w.centroid.z); }
        printf(" beams %.4f %.4f tubes %.4f %.4f\n", v[0].real(), v[0].imag(), v[1].real(), v[1].imag());
      }
    }
    printf("\n");
    fflush(stdout);
  }
}
}  // namespace
}  // namespace greatx::rf
