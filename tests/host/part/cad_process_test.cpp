#include "host/part/cad_process.hpp"

#include <gmock/gmock.h>
#include <sys/wait.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <thread>
#include <vector>

#include "host/base/random.hpp"
#include "host/part/brep_packing.hpp"
#include "tests/host/part/shipped_parts.hpp"

namespace pinjaw::part {
namespace {

using testing::EndsWith;
using testing::HasSubstr;

/// Sets an environment variable for as long as it lives.
class Setting {
 public:
  Setting(const char* name, const char* value) : name_(name) { ::setenv(name, value, 1); }
  ~Setting() { ::unsetenv(name_); }
  Setting(const Setting&) = delete;
  Setting& operator=(const Setting&) = delete;

 private:
  const char* name_;
};

std::string refusal_of(const std::string& name) {
  const auto part = read_part(source_of(shipped(name)));
  return part ? "it was read" : part.error().message;
}

TEST(CadProcess, a_crash_is_told_with_the_file_and_what_was_being_done) {
  const auto answer =
      in_cad_process("x.step", [](const base::IsolatedStage& stage) -> base::Expected<std::string> {
        stage("reading its edges");
        std::raise(SIGSEGV);
        return "";
      });
  ASSERT_FALSE(answer);
  EXPECT_EQ(answer.error().message,
            "x.step: OpenCASCADE crashed (SIGSEGV) while reading its edges; the file may be damaged");
}

TEST(CadProcess, a_part_that_takes_too_long_is_told_with_the_way_out) {
  const Setting seconds("PINJAW_CAD_SECONDS", "0.001");
  EXPECT_THAT(refusal_of("valve_housing"),
              HasSubstr("valve_housing.step: OpenCASCADE takes longer than 0.001 s"));
  EXPECT_THAT(refusal_of("valve_housing"), EndsWith("; PINJAW_CAD_SECONDS allows more"));
}

#if !defined(__SANITIZE_ADDRESS__)  // whose address space cannot be limited
TEST(CadProcess, a_part_that_needs_too_much_memory_is_told_with_the_way_out) {
  const Setting memory("PINJAW_CAD_MEMORY_MB", "16");
  EXPECT_THAT(refusal_of("valve_housing"), HasSubstr("OpenCASCADE needs more than 16 MB of memory while "));
  EXPECT_THAT(refusal_of("valve_housing"), EndsWith("; PINJAW_CAD_MEMORY_MB allows more"));
}
#endif

TEST(CadProcess, limits_that_say_nothing_sensible_are_told) {
  for (const char* nonsense : {"x", "-1", "0", "1e999", "10s", "nan"}) {
    const Setting seconds("PINJAW_CAD_SECONDS", nonsense);
    EXPECT_EQ(refusal_of("l_bracket"),
              std::string("PINJAW_CAD_SECONDS: expected seconds from 0.001 to 86400, found ") + nonsense);
  }
  const Setting empty("PINJAW_CAD_MEMORY_MB", "");
  EXPECT_EQ(cad_limits()->memory_mb, base::IsolationLimits{}.memory_mb);
}

TEST(CadProcess, several_threads_read_parts_at_once_and_leave_no_process_behind) {
  std::vector<double> volumes(4);
  {
    std::vector<std::jthread> readers;
    for (double& volume_mm3 : volumes) {
      readers.emplace_back([&volume_mm3] {
        const auto part = read_part(source_of(shipped("l_bracket")));
        if (part) volume_mm3 = part->volume_mm3;
      });
    }
  }
  EXPECT_GT(volumes.front(), 0);
  EXPECT_THAT(volumes, testing::Each(volumes.front()));
  EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), -1);
  EXPECT_EQ(errno, ECHILD);
}

/// Values of every kind, small.
BrepValues some_values() {
  BrepValues values;
  values.solids = {{"a", 1}, {"", 2.5}};
  values.mass = {3.5, {1, 2, 3}};
  values.edges.edges = {{.edge = 1, .curve = Line3{{0, 0, 0}, {1, 0, 0}}, .faces = {1, 2}},
                        {.edge = 2, .curve = Ellipse3{{1, 1, 1}, {1, 0, 0}, {0, 1, 0}, 0.5, 2}},
                        {.edge = 5, .curve = Polyline3{{{0, 0, 0}, {1, 1, 1}, {2, 0, 0}}}, .error_mm = 0.01}};
  values.edges.counts = {.total = 5, .kept = 3, .seams = 1, .degenerate = 1, .freeform = 1};
  values.wall_faces = {{1, PlaneFace{{1, 0, 0}}}, {2, CylinderFace{{0, 0, 1}, {0, 0, 1}, 4}}};
  values.mesh.mesh.vertices_mm = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  values.mesh.mesh.triangles = {{0, 1, 2}};
  values.mesh.mesh.face_of = {7};
  values.mesh.mesh.silhouettes = {{7, {{0, 0, 0}, {1, 0, 0}}, {1.5, 2.5}}};
  values.mesh.deflection_mm = 0.004;
  return values;
}

TEST(Packing, brings_every_value_back) {
  const auto back = unpacked(packed(some_values()));
  ASSERT_TRUE(back);
  EXPECT_EQ(packed(*back), packed(some_values()));
  EXPECT_EQ(back->solids[1].volume_mm3, 2.5);
  EXPECT_EQ(std::get<Ellipse3>(back->edges.edges[1].curve).sweep_rad, 2);
  EXPECT_EQ(std::get<Polyline3>(back->edges.edges[2].curve).points_mm.size(), 3U);
  EXPECT_EQ(back->edges.edges[2].error_mm, 0.01);
  EXPECT_EQ(back->edges.counts, some_values().edges.counts);
  EXPECT_EQ(std::get<CylinderFace>(back->wall_faces[1].surface).radius_mm, 4);
  EXPECT_EQ(back->mesh.mesh.silhouettes[0].radius_mm[1], 2.5);
}

TEST(Packing, refuses_bytes_that_are_cut_or_go_on) {
  const std::string whole = packed(some_values());
  for (std::size_t i = 0; i < whole.size(); ++i) EXPECT_FALSE(unpacked(whole.substr(0, i))) << i;
  EXPECT_FALSE(unpacked(whole + "x"));
}

TEST(Packing, refuses_values_that_contradict_each_other) {
  BrepValues no_such_vertex = some_values();
  no_such_vertex.mesh.mesh.triangles[0][1] = 3;
  EXPECT_FALSE(unpacked(packed(no_such_vertex)));
  BrepValues no_number = some_values();
  no_number.mesh.mesh.vertices_mm[0].x() = std::nan("");
  EXPECT_FALSE(unpacked(packed(no_number)));
  BrepValues no_face = some_values();
  no_face.mesh.mesh.face_of.clear();
  EXPECT_FALSE(unpacked(packed(no_face)));
}

TEST(Packing, answers_damaged_bytes) {
  const std::string whole = packed(some_values());
  base::Random random(5);
  int refused = 0;
  for (int round = 0; round < 3000; ++round) {
    std::string bytes = whole;
    bytes[random.bits() % bytes.size()] = static_cast<char>(random.bits());
    refused += unpacked(bytes) ? 0 : 1;
  }
  EXPECT_GT(refused, 0);
}

}  // namespace
}  // namespace pinjaw::part
