#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "host/base/random.hpp"
#include "host/part/stl_mesh.hpp"
#include "tests/host/geometry/solids.hpp"
#include "tests/host/part/stl_bytes.hpp"

namespace pinjaw::part {
namespace {

using testing::HasSubstr;

constexpr int kMost = 1000;

geometry::TriangleMesh cube() {
  return geometry::testing::block({{1, 2, 3}, {4, 6, 8}});
}

std::string refusal_of(const std::string& bytes) {
  const auto mesh = read_stl_mesh(bytes, "part.stl", kMost);
  return mesh ? "it was read" : mesh.error().message;
}

std::string replaced(std::string text, const std::string& what, const std::string& with) {
  return text.replace(text.find(what), what.size(), with);
}

TEST(Stl, binary_and_ascii_give_the_same_mesh) {
  const auto binary = read_stl_mesh(binary_stl(cube()), "part.stl", kMost);
  const auto ascii = read_stl_mesh(ascii_stl(cube()), "part.stl", kMost);
  ASSERT_TRUE(binary && ascii);
  EXPECT_EQ(binary->mesh.vertices_mm, ascii->mesh.vertices_mm);
  EXPECT_EQ(binary->mesh.triangles, ascii->mesh.triangles);
  EXPECT_EQ(binary->mesh.vertices_mm.size(), 8U);
}

TEST(Stl, a_binary_file_may_begin_with_solid) {
  EXPECT_EQ(refusal_of(binary_stl(cube(), "solid by an exporter of note")), "it was read");
}

TEST(Stl, ascii_may_be_in_capitals_and_on_lines_of_any_kind) {
  std::string text = ascii_stl(cube());
  for (char& c : text) {
    if (c == '\n') c = '\r';
  }
  text = replaced(text, "facet normal", "FACET Normal");
  EXPECT_EQ(refusal_of(text), "it was read");
}

TEST(Stl, normals_that_are_no_numbers_do_not_matter) {
  EXPECT_EQ(refusal_of(replaced(ascii_stl(cube()), "normal 0 0 0", "normal nan abc inf")),
            "part.stl:2:20: expected a number, found \"abc\"");
  EXPECT_EQ(refusal_of(replaced(ascii_stl(cube()), "normal 0 0 0", "normal nan -nan(ind) 1e999")),
            "it was read");
}

TEST(HostileStl, an_empty_file_is_called_empty) {
  EXPECT_EQ(refusal_of(""), "part.stl: the file is empty");
}

TEST(HostileStl, text_is_not_stl) {
  const std::string says =
      "part.stl: not an STL file: it neither begins with solid nor has the 84 bytes of a binary header";
  EXPECT_EQ(refusal_of("Dear customer"), says);
  EXPECT_EQ(refusal_of(std::string(500, 'x')), says);
}

TEST(HostileStl, a_binary_file_cut_short_says_what_is_missing) {
  const std::string whole = binary_stl(cube());
  EXPECT_EQ(
      refusal_of(whole.substr(0, 600)),
      "part.stl: the STL file is cut short: its header states 12 facets, which take 684 bytes; found 600");
  for (std::size_t size = 1; size < whole.size(); ++size)
    EXPECT_NE(refusal_of(whole.substr(0, size)), "it was read");
}

TEST(HostileStl, a_count_that_lies_is_told) {
  EXPECT_EQ(refusal_of(binary_stl(cube()) + "more"),
            "part.stl: the STL file's header states 12 facets, which take 684 bytes; found 688");
  std::string none = binary_stl({});
  EXPECT_EQ(refusal_of(none), "part.stl: the STL file holds no facet");
  std::string billions = binary_stl(cube());
  billions.replace(80, 4, "\x00\xff\xff\xff", 4);
  EXPECT_THAT(refusal_of(billions), HasSubstr("its header states 4294967040 facets"));
}

TEST(HostileStl, a_corner_that_is_no_number_or_far_away_is_named) {
  std::string bytes = binary_stl(cube());
  bytes.replace(84 + 2 * 50 + 12 + 12 + 8, 4, little_endian(std::nan("")));
  EXPECT_EQ(refusal_of(bytes), "part.stl: facet 3, corner 2, z: expected a number, found nan");
  bytes.replace(84 + 2 * 50 + 12 + 12 + 8, 4, little_endian(-2e5));
  EXPECT_EQ(refusal_of(bytes),
            "part.stl: facet 3, corner 2, z: expected a length up to 100000 mm, found -200000");
  const std::string text = replaced(ascii_stl(cube()), "vertex 1.0", "vertex inf 1.0");
  EXPECT_THAT(refusal_of(text), HasSubstr(": expected a number, found inf"));
}

TEST(HostileStl, too_many_facets_are_refused_before_they_are_kept) {
  const auto round = geometry::testing::cylinder({{0, 0}, 10, 0, 0}, {0, 5}, 300);
  for (const std::string& bytes : {binary_stl(round), ascii_stl(round)}) {
    EXPECT_EQ(refusal_of(bytes), "part.stl: the STL file holds more than 1000 facets; export it coarser");
  }
}

TEST(HostileStl, ascii_mistakes_are_placed_by_line_and_column) {
  const std::string good = ascii_stl(cube());
  EXPECT_EQ(refusal_of(replaced(good, "outer loop", "outer lop")),
            "part.stl:3:11: expected loop, found \"lop\"");
  EXPECT_THAT(refusal_of(replaced(good, "endloop", "vertex")),
              HasSubstr("part.stl:7:5: expected endloop, found \"vertex\""));
  EXPECT_THAT(refusal_of(good + "facet"), HasSubstr("expected solid, found \"facet\""));
  EXPECT_EQ(refusal_of("solid a\nendsolid a\n"), "part.stl: the STL file holds no facet");
  EXPECT_THAT(refusal_of(replaced(good, "vertex", "vertex 1,5")),
              HasSubstr("expected a number, found \"1,5\""));
}

TEST(HostileStl, ascii_cut_anywhere_is_refused) {
  const std::string whole = ascii_stl(cube());
  const std::size_t end = whole.rfind("endsolid");
  for (std::size_t size = 1; size < end; size += 7) {
    const std::string says = refusal_of(whole.substr(0, size));
    EXPECT_NE(says, "it was read") << size;
    EXPECT_THAT(says, HasSubstr("part.stl:")) << size;
  }
}

TEST(HostileStl, any_bytes_get_a_mesh_or_a_sentence) {
  base::Random random(5);
  const std::string seeds[] = {binary_stl(cube()), ascii_stl(cube())};
  for (int round = 0; round < 3000; ++round) {
    std::string bytes = seeds[round % 2];
    for (std::uint64_t hits = 0; hits < 1 + random.bits() % 8; ++hits) {
      bytes[random.bits() % bytes.size()] = static_cast<char>(random.bits());
    }
    const auto mesh = read_stl_mesh(bytes, "part.stl", kMost);
    if (mesh) {
      EXPECT_FALSE(mesh->mesh.triangles.empty());
    } else {
      EXPECT_THAT(mesh.error().message, HasSubstr("part.stl"));
      EXPECT_EQ(mesh.error().message.find('\n'), std::string::npos);
    }
  }
}

}  // namespace
}  // namespace pinjaw::part
