#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "host/config/fields.hpp"
#include "host/config/profile_shape.hpp"
#include "host/config/read.hpp"

namespace pinjaw::config {
namespace {

using base::YamlMap;
using base::YamlValue;
using model::ProfileEdge;

/// A loop, and where each of its edges stands in the file.
struct WrittenLoop {
  YamlValue at;
  std::vector<ProfileEdge> edges;
  std::vector<YamlValue> edge_at;
  bool whole = true;  ///< every edge could be read
};

std::string shown(const Vector2d& p_mm) {
  return fmt::format("({:.6g}, {:.6g})", p_mm.x(), p_mm.y());
}

void read_polygon(const YamlValue& value, WrittenLoop& loop) {
  const auto items = value.list("3 or more points [[x, y], ...]", {3, 2000});
  loop.whole = items.has_value();
  if (!items) return;
  std::vector<std::optional<Vector2d>> points;
  for (const YamlValue& item : *items) points.push_back(point2(item));
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::size_t next = (i + 1) % points.size();
    loop.whole = loop.whole && points[i].has_value();
    if (!points[i] || !points[next]) continue;
    if ((*points[next] - *points[i]).norm() <= kSamePoint_mm) {
      (*items)[next].mistake("the same point as its neighbour; the loop closes by itself");
      loop.whole = false;
    }
    ProfileEdge edge;
    edge.curve = geometry::Segment{*points[i], *points[next]};
    loop.edges.push_back(edge);
    loop.edge_at.push_back((*items)[i]);
  }
}

std::optional<geometry::Curve> read_line(const YamlValue& value) {
  const auto ends = value.list("two points [[x, y], [x, y]]", {2, 2});
  if (!ends) return {};
  const auto a = point2((*ends)[0]);
  const auto b = point2((*ends)[1]);
  if (!a || !b) return {};
  if ((*b - *a).norm() > kSamePoint_mm) return geometry::Segment{*a, *b};
  value.mistake("a line from a point to itself");
  return {};
}

/// Counter-clockwise where `to_deg` is above `from_deg`; else `reversed`, and stored counter-clockwise.
std::optional<geometry::Curve> read_arc(const YamlValue& value, bool& reversed) {
  YamlMap map = value.map("settings {center, radius, from_deg, to_deg}");
  const auto center_value = map.require("center");
  const auto center = center_value ? point2(*center_value) : std::nullopt;
  const double radius_mm = map.number("radius", length_above_0());
  base::NumberRule turn{"an angle from -720 to 720 degrees"};
  turn.at_least = -720;
  turn.at_most = 720;
  const double from_deg = map.number("from_deg", turn);
  const double to_deg = map.number("to_deg", turn);
  map.finish();
  const double sweep_deg = std::abs(to_deg - from_deg);
  if (sweep_deg > 360)
    map.mistake_at("to_deg", fmt::format("turns {:.6g} degrees, more than a full circle", sweep_deg));
  if (sweep_deg * kRadPerDeg * radius_mm <= kSamePoint_mm) map.mistake_at("to_deg", "an arc without length");
  if (!center || !(radius_mm > 0) || !(sweep_deg > 0) || sweep_deg > 360) return {};
  reversed = to_deg < from_deg;
  return geometry::Arc{*center, radius_mm, std::min(from_deg, to_deg) * kRadPerDeg, sweep_deg * kRadPerDeg};
}

void read_edge(const YamlValue& item, WrittenLoop& loop) {
  YamlMap map = item.map("an edge {line: ...} or {arc: ...}");
  const auto line = map.find("line");
  const auto arc = map.find("arc");
  ProfileEdge edge;
  std::optional<geometry::Curve> curve;
  if (line) curve = read_line(*line);
  if (arc) curve = read_arc(*arc, edge.reversed);
  if (const auto graspable = map.find("graspable")) edge.graspable = graspable->truth().value_or(true);
  if (map.present() && line.has_value() == arc.has_value()) map.mistake("expected one of line and arc");
  map.finish();
  loop.whole = loop.whole && curve.has_value();
  if (!curve) return;
  edge.curve = *curve;
  loop.edges.push_back(edge);
  loop.edge_at.push_back(item);
}

void check_closed(WrittenLoop& loop) {
  for (std::size_t i = 0; i < loop.edges.size(); ++i) {
    const std::size_t before = (i + loop.edges.size() - 1) % loop.edges.size();
    const Vector2d start_mm = start_of(loop.edges[i]);
    const Vector2d end_mm = end_of(loop.edges[before]);
    if ((start_mm - end_mm).norm() <= kSamePoint_mm) continue;
    loop.whole = false;
    loop.edge_at[i].mistake(
        fmt::format("starts at {}, but the edge before it ends at {}", shown(start_mm), shown(end_mm)));
  }
}

WrittenLoop read_loop(const YamlValue& item) {
  WrittenLoop loop{item, {}, {}, true};
  YamlMap map = item.map("a loop {polygon: [...]} or {edges: [...]}");
  const auto polygon = map.find("polygon");
  const auto edges = map.find("edges");
  loop.whole = polygon.has_value() != edges.has_value();
  if (map.present() && !loop.whole) map.mistake("expected one of polygon and edges");
  map.finish();
  if (!loop.whole) return loop;
  if (polygon) read_polygon(*polygon, loop);
  if (!edges) return loop;
  const auto items = edges->list("a list of edges [{line: ...}, {arc: ...}, ...]", {1, 2000});
  loop.whole = items.has_value();
  for (const YamlValue& edge : items.value_or(std::vector<YamlValue>{})) read_edge(edge, loop);
  if (loop.whole) check_closed(loop);
  return loop;
}

/// The ends that edges `i` and `j` of one loop of `count` edges have in common because they are neighbours.
std::vector<Vector2d> shared_ends(const std::vector<ProfileEdge>& edges, std::size_t i, std::size_t j) {
  std::vector<Vector2d> shared;
  if (j == i + 1) shared.push_back(end_of(edges[i]));
  if (i == 0 && j + 1 == edges.size()) shared.push_back(start_of(edges[i]));
  return shared;
}

/// Reports, for each edge, the first earlier edge that it meets elsewhere than at a common end.
bool check_crossings(const std::vector<WrittenLoop>& loops) {
  bool clean = true;
  for (std::size_t l = 0; l < loops.size(); ++l) {
    for (std::size_t j = 0; j < loops[l].edges.size(); ++j) {
      bool found = false;
      for (std::size_t k = 0; k <= l && !found; ++k) {
        for (std::size_t i = 0; i < (k == l ? j : loops[k].edges.size()) && !found; ++i) {
          const auto shared = k == l ? shared_ends(loops[l].edges, i, j) : std::vector<Vector2d>{};
          const auto points = meetings(loops[k].edges[i], loops[l].edges[j], shared);
          found = !points.empty();
          if (!found) continue;
          loops[l].edge_at[j].mistake(
              fmt::format("crosses or touches {} at {}", loops[k].edge_at[i].path(), shown(points.front())));
        }
      }
      clean = clean && !found;
    }
  }
  return clean;
}

void check_directions(const std::vector<WrittenLoop>& loops) {
  for (std::size_t l = 0; l < loops.size(); ++l) {
    const bool counter_clockwise = signed_area_mm2(loops[l].edges) > 0;
    if (l == 0 && !counter_clockwise) {
      loops[l].at.mistake("the first loop is the outer one and must run counter-clockwise");
    }
    if (l == 0) continue;
    if (counter_clockwise) loops[l].at.mistake("a hole must run clockwise (the first loop is the outer one)");
    const Vector2d p_mm = start_of(loops[l].edges.front());
    if (!is_inside(p_mm, loops[0].edges)) loops[l].at.mistake("this hole lies outside the first loop");
    for (std::size_t k = 1; k < loops.size(); ++k) {
      if (k != l && is_inside(p_mm, loops[k].edges))
        loops[l].at.mistake("this hole lies inside another hole");
    }
  }
}

}  // namespace

Read<model::Profile> read_profile(const std::filesystem::path& path) {
  base::YamlFile file(path);
  YamlMap top = top_of(file, "profile");
  model::Profile profile;
  profile.name = top.text("profile", "a name");
  profile.thickness_mm = top.number("thickness_mm", length_above_0());
  std::vector<WrittenLoop> loops;
  if (const auto list = top.require("loops")) {
    const auto items = list->list("a list of loops, the outer one first", {1, 100});
    for (const YamlValue& item : items.value_or(std::vector<YamlValue>{})) loops.push_back(read_loop(item));
  }
  top.finish();
  bool whole = true;
  std::size_t edge_count = 0;
  for (const WrittenLoop& loop : loops) {
    whole = whole && loop.whole;
    edge_count += loop.edges.size();
  }
  constexpr std::size_t kMostEdges = 4000;  // chosen: 8 million pairs to try, under a second
  if (edge_count > kMostEdges) top.mistake_at("loops", fmt::format("more than {} edges", kMostEdges));
  if (whole && edge_count <= kMostEdges && check_crossings(loops)) check_directions(loops);
  for (WrittenLoop& loop : loops) profile.loops.push_back(std::move(loop.edges));
  return checked(file, {}, std::move(profile));
}

}  // namespace pinjaw::config
