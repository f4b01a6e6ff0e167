#include "tests/host/planner/planar/read_case.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>

#include "tests/support/places.hpp"

namespace pinjaw::planner {
namespace {

using geometry::Vector2d;
using nlohmann::json;

constexpr double kDegree = std::numbers::pi / 180;

json read_json(const std::string& name, const std::string& file) {
  std::ifstream in(test::source_dir("tests/host/planner/planar/cases/" + name + "/" + file));
  return json::parse(in);
}

Vector2d point_of(const json& value) {
  return Vector2d(value.at(0).get<double>(), value.at(1).get<double>());
}

model::ProfileEdge edge_of(const json& value) {
  model::ProfileEdge edge;
  if (value.contains("line")) {
    edge.curve = geometry::Segment{point_of(value.at("line").at(0)), point_of(value.at("line").at(1))};
    return edge;
  }
  const json& arc = value.at("arc");
  const double from_rad = arc.at("from_deg").get<double>() * kDegree;
  const double to_rad = arc.at("to_deg").get<double>() * kDegree;
  edge.reversed = to_rad < from_rad;
  edge.curve = geometry::Arc{point_of(arc.at("center")), arc.at("radius"), std::min(from_rad, to_rad),
                             std::abs(to_rad - from_rad)};
  return edge;
}

model::Profile profile_of(const json& file) {
  model::Profile profile;
  profile.name = file.at("profile");
  profile.thickness_mm = file.at("thickness_mm");
  for (const json& loop : file.at("loops")) {
    std::vector<model::ProfileEdge> edges;
    if (loop.contains("polygon")) {
      std::vector<Vector2d> points;
      for (const json& point : loop["polygon"]) points.push_back(point_of(point));
      edges = polygon(points);
    } else {
      for (const json& edge : loop.at("edges")) edges.push_back(edge_of(edge));
    }
    profile.loops.push_back(edges);
  }
  return profile;
}

model::Kit kit_of(const json& file) {
  model::Kit kit;
  kit.name = file.at("kit");
  const json& grid = file.at("grid");
  kit.grid = {grid.at("spacing_mm"), grid.at("columns"), grid.at("rows"), grid.at("edge_offset_mm")};
  kit.pins.radius_mm = file.at("pins").at("radius_mm");
  const json& separation = file.at("jaws").at("separation_mm");
  kit.jaws.separation_mm = {separation.at(0).get<double>(), separation.at(1).get<double>()};
  kit.jaws.plate_gap_mm = file.at("jaws").at("plate_gap_mm");
  return kit;
}

KnownFixture fixture_of(const json& value) {
  KnownFixture fixture;
  fixture.split = value.at("split");
  fixture.theta_rad = value.at("theta_deg").get<double>() * kDegree;
  fixture.span_mm = value.at("span_mm");
  fixture.borderline = value.at("borderline");
  for (const json& pin : value.at("pins")) {
    const auto jaw = pin.at("jaw") == "left" ? model::JawSide::Left : model::JawSide::Right;
    fixture.pins.push_back({{jaw, pin.at("col"), pin.at("row")}, pin.at("loop"), pin.at("edge")});
  }
  std::sort(fixture.pins.begin(), fixture.pins.end());
  return fixture;
}

}  // namespace

std::vector<model::ProfileEdge> polygon(const std::vector<geometry::Vector2d>& points) {
  std::vector<model::ProfileEdge> edges;
  for (std::size_t i = 0; i < points.size(); ++i) {
    model::ProfileEdge edge;
    edge.curve = geometry::Segment{points[i], points[(i + 1) % points.size()]};
    edges.push_back(edge);
  }
  return edges;
}

KnownCase read_case(const std::string& name) {
  KnownCase known;
  known.profile = profile_of(read_json(name, "profile.yaml"));
  known.kit = kit_of(read_json(name, "kit.yaml"));
  const json expected = read_json(name, "expected.json");
  for (const json& fixture : expected.at("fixtures")) {
    known.fixtures.push_back(fixture_of(fixture));
  }
  return known;
}

}  // namespace pinjaw::planner
