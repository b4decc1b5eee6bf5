#include "karcher/io/page.hpp"

#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <numeric>
#include <set>

#include "io/binary.hpp"
#include "io/fields.hpp"
#include "io/page_data.hpp"
#include "io/page_geometry.hpp"
#include "io/page_store.hpp"
#include "karcher/error.hpp"
#include "karcher/io/atomic_file.hpp"
#include "karcher/manifold/sphere.hpp"
#include "temporary_directory.hpp"

namespace karcher {
namespace {

using testing::field_on;
using testing::generated;
using testing::nodal;

using nlohmann::json;

/// What a browser reads out of a page, after the description in page_data.hpp.
struct ReadPage {
  std::string html;
  json header;
  std::string bytes;

  std::vector<double> array(int index) const {
    const json& info = header.at("arrays").at(static_cast<std::size_t>(index));
    const std::size_t n = info.at("count"), components = info.at("components"), offset = info.at("offset");
    const std::string type = info.at("type");
    const std::size_t width = type == "u16" ? 2 : 4;
    std::vector<double> out(n * components);
    for (std::size_t c = 0; c < components; ++c) {
      std::uint32_t last = 0;
      for (std::size_t i = 0; i < n; ++i) {
        std::uint32_t w = 0;
        for (std::size_t b = 0; b < width; ++b)
          w |= std::uint32_t{static_cast<unsigned char>(bytes.at(offset + c * n * width + b * n + i))} << (8 * b);
        double& v = out[i * components + c];
        if (type == "f32") {
          float f = 0;
          std::memcpy(&f, &w, sizeof f);
          v = f;
          continue;
        }
        last += w & 1 ? ~(w >> 1) : w >> 1;
        if (type == "u32") {
          v = last;
          continue;
        }
        last &= 0xffff;
        const double low = info.at("low").at(c), high = info.at("high").at(c);
        v = last == 65535 ? NAN : low + (high - low) * last / 65534;
      }
    }
    return out;
  }
  const json& shape() const { return header.at("shape"); }
  json field(const std::string& name) const {
    for (const json& f : shape().at("fields"))
      if (f.at("name") == name) return f;
    throw std::runtime_error("no field " + name);
  }
};

ReadPage unpacked(const std::string& text) {
  std::string packed;
  unsigned bits = 0;
  int held = 0;
  for (const char c : text) {
    const auto digit = std::string_view("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/").find(c);
    if (digit == std::string_view::npos) break;
    bits = bits << 6 | static_cast<unsigned>(digit);
    if ((held += 6) >= 8) packed += static_cast<char>(bits >> (held -= 8) & 255);
  }
  std::string plain(100 << 20, '\0');
  uLongf size = plain.size();
  if (uncompress(reinterpret_cast<Bytef*>(plain.data()), &size, reinterpret_cast<const Bytef*>(packed.data()), packed.size()) != Z_OK)
    throw std::runtime_error("not a zlib stream");
  if (plain.compare(0, 8, "KARCHER1") != 0) throw std::runtime_error("no magic word");
  std::uint32_t length = 0;
  std::memcpy(&length, plain.data() + 8, 4);
  return {{}, json::parse(plain.substr(12, length)), plain.substr(12 + length, size - 12 - length)};
}

ReadPage read_page(const std::filesystem::path& directory) {
  std::string html = read_whole(directory / "report.html");
  const std::string begin = "<script id=\"karcher-data\" type=\"text/plain\">";
  const std::size_t a = html.find(begin) + begin.size();
  ReadPage page = unpacked(html.substr(a, html.find('<', a) - a));
  page.html = std::move(html);
  return page;
}

std::vector<double> identity(const Vec3<double>& x) { return {x[0], x[1], x[2]}; }

Summary summary_of(const std::string& title) {
  Summary s;
  s.title = title;
  s.version = "1.2.3";
  s.status = Status::converged;
  s.reason = "It converged.";
  return s;
}

/// A store with the given states of a single deformation, without files.
Store stored(const std::shared_ptr<const Mesh>& mesh, int order, const std::vector<std::function<std::vector<double>(const Vec3<double>&)>>& maps,
             const std::filesystem::path& directory) {
  OutputModel model;
  model.fields = {field_on(mesh, mesh->region("all"), "m", "R3", order)};
  model.deformation = 0;
  PageStates states(directory, model);
  const OutputSampler output(model);
  int k = 0;
  for (const auto& map : maps) {
    states.write(k, k, output.sample({{nodal(model.fields[0], map)}, 0}));
    ++k;
  }
  return read_store(directory / "report.data");
}

std::vector<int> all_states(const Store& store) {
  std::vector<int> out;
  for (std::size_t k = 0; k < store.states.size(); ++k) out.push_back(static_cast<int>(k));
  return out;
}

std::vector<Vec3<double>> places(const PageGeometry& shape, const Store& store) {
  std::vector<Vec3<double>> x(shape.vertices.size());
  for (std::size_t v = 0; v < x.size(); ++v) shape.interpolate(v, store.parts.at(0).reference, 3, &x[v][0]);
  return x;
}

double area(const PageGeometry& shape, const std::vector<Vec3<double>>& x) {
  double sum = 0;
  for (std::size_t t = 0; t < shape.triangle_facets.size(); ++t) {
    const Vec3<double> n =
        cross(x[shape.triangles[3 * t + 1]] - x[shape.triangles[3 * t]], x[shape.triangles[3 * t + 2]] - x[shape.triangles[3 * t]]);
    sum += 0.5 * std::sqrt(dot(n, n));
  }
  return sum;
}

/// How many triangle edges belong to 1, 2, ... triangles.
std::map<int, int> edge_uses(const PageGeometry& shape) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> uses;
  for (std::size_t t = 0; t < shape.triangle_facets.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) ++uses[std::minmax(shape.triangles[3 * t + k], shape.triangles[3 * t + (k + 1) % 3])];
  std::map<int, int> count;
  for (const auto& [edge, n] : uses) ++count[n];
  return count;
}

int euler_characteristic(const PageGeometry& shape) {
  const std::set<std::uint32_t> used(shape.triangles.begin(), shape.triangles.end());
  int edges = 0;
  for (const auto& [n, count] : edge_uses(shape)) edges += count;
  return static_cast<int>(used.size()) - edges + static_cast<int>(shape.triangle_facets.size());
}

TEST(PageArrays, NumbersComeBackWithinHalfAStepOfTheirRange) {
  PageArrays arrays;
  std::vector<float> values;
  for (int i = 0; i < 1000; ++i) values.insert(values.end(), {static_cast<float>(std::sin(0.1 * i)), static_cast<float>(1e6 * i * i), -7.0F});
  values[30] = NAN;
  values[31] = INFINITY;
  const std::vector<std::uint32_t> integers{5, 4, 4000000000U, 0, 1, 7};
  const int a = arrays.add_quantised(values, 3), b = arrays.add_floats(values, 3), c = arrays.add_integers(integers, 2);
  const ReadPage page = unpacked(arrays.packed({{"title", "x"}}));
  const std::vector<double> q = page.array(a), f = page.array(b), n = page.array(c);
  ASSERT_EQ(q.size(), values.size());
  const double step[] = {2.0 / 65534, 1e6 * 999 * 999 / 65534, 0};
  for (std::size_t i = 0; i < values.size(); ++i) {
    EXPECT_EQ(std::isnan(q[i]), i == 30 || i == 31);
    EXPECT_EQ(std::isnan(f[i]), i == 30);
    if (std::isnan(q[i])) continue;
    EXPECT_NEAR(q[i], values[i], 0.5001 * step[i % 3] + 1e-12);
    EXPECT_EQ(f[i], static_cast<double>(values[i]));
  }
  EXPECT_EQ(f[31], INFINITY);
  for (std::size_t i = 0; i < integers.size(); ++i) EXPECT_EQ(n[i], integers[i]);
}

TEST(PageGeometry, CutsOfACurvedClosedSurfaceFitTogetherAndHaveItsAreaAndTopology) {
  const TemporaryDirectory directory;
  // A bump that stretches a few elements: they are cut finer than the others, and still nothing gapes.
  const auto bump = [](const Vec3<double>& x) {
    const double h = 1 + 0.6 * std::exp(-20 * ((x[0] - 1) * (x[0] - 1) + x[1] * x[1] + x[2] * x[2]));
    return std::vector<double>{h * x[0], h * x[1], h * x[2]};
  };
  const Store store = stored(generated("sphere", {{"cells", {4}}, {"order", {3}}}), 3, {identity, bump}, directory.path());
  const PageGeometry shape = page_geometry(store, all_states(store), 200000);
  EXPECT_EQ(edge_uses(shape).size(), 1U);
  EXPECT_GT(edge_uses(shape)[2], 0);
  EXPECT_EQ(euler_characteristic(shape), 2);
  const PageGeometry plain = page_geometry(store, {0}, 200000);
  EXPECT_GT(shape.triangle_facets.size(), plain.triangle_facets.size());
  const std::vector<Vec3<double>> x = places(shape, store);
  for (const Vec3<double>& p : x) EXPECT_NEAR(dot(p, p), 1, 2e-3);  // of cubic elements, not of their chords
  EXPECT_NEAR(area(shape, x), 4 * std::numbers::pi, 0.005 * 4 * std::numbers::pi);
  // Edges are polylines through vertices of the shape: no gap between an edge and the surface beside it.
  std::set<std::pair<std::uint32_t, std::uint32_t>> sides;
  for (std::size_t t = 0; t < shape.triangle_facets.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) sides.insert(std::minmax(shape.triangles[3 * t + k], shape.triangles[3 * t + (k + 1) % 3]));
  std::size_t at = 0;
  for (const std::uint32_t length : shape.edge_lengths) {
    for (std::size_t i = at + 1; i < at + length; ++i) EXPECT_TRUE(sides.count(std::minmax(shape.edges[i - 1], shape.edges[i])));
    at += length;
  }
  EXPECT_EQ(shape.edge_lengths.size(), 30U * 16);  // an icosahedron with each edge cut into four
  EXPECT_EQ(shape.strong_edges, 0);
}

TEST(PageGeometry, AKleinBottleStaysClosedAndOneSided) {
  const TemporaryDirectory directory;
  const Store store = stored(generated("klein-bottle", {{"cells", {12, 8}}, {"order", {2}}}), 2, {identity}, directory.path());
  const PageGeometry shape = page_geometry(store, {0}, 200000);
  EXPECT_EQ(edge_uses(shape).size(), 1U);
  EXPECT_EQ(edge_uses(shape).begin()->first, 2);
  EXPECT_EQ(euler_characteristic(shape), 0);
}

TEST(PageGeometry, OfASolidTheBoundaryIsShownWithItsCreasesStrong) {
  const TemporaryDirectory directory;
  for (const char* kind : {"tetrahedron", "hexahedron"}) {
    const Store store = stored(generated("box", {{"size", {4, 1, 2}}, {"cells", {4, 1, 2}}}, {{"shape", kind}}), 1, {identity}, directory.path());
    const PageGeometry shape = page_geometry(store, {0}, 200000);
    EXPECT_NEAR(area(shape, places(shape, store)), 2 * (4 + 8 + 2), 1e-5);
    EXPECT_EQ(edge_uses(shape).size(), 1U);
    EXPECT_EQ(euler_characteristic(shape), 2);
    EXPECT_EQ(shape.strong_edges, 4 * (4 + 1 + 2)) << kind;  // unit edges on the twelve edges of the box
  }
}

TEST(PageGeometry, EveryFaceBetweenTwoCellsOfASolidIsThereOnceWithTheCellsOnBothSides) {
  const TemporaryDirectory directory;
  for (const char* kind : {"tetrahedron", "hexahedron"})
    for (const int order : {1, 2}) {
      const auto mesh = generated("box", {{"size", {2, 1, 1}}, {"cells", {4, 2, 2}}}, {{"shape", kind}});
      const Store store = stored(mesh, order, {identity}, directory.path());
      const PageGeometry shape = page_geometry(store, {0}, 200000);
      const bool tetrahedra = std::string(kind) == "tetrahedron";
      const int faces = tetrahedra ? 4 : 6;
      std::set<std::uint32_t> outer(shape.triangle_facets.begin(), shape.triangle_facets.end()),
          inner(shape.inner_facets.begin(), shape.inner_facets.end());
      EXPECT_EQ(outer.size() + 2 * inner.size(), mesh->cells.size() * static_cast<std::size_t>(faces)) << kind << order;
      EXPECT_EQ(shape.facets.size(), outer.size() + 2 * inner.size());
      ASSERT_EQ(shape.solid_cells.size(), shape.facets.size());
      std::map<std::uint32_t, int> count;
      for (const std::uint32_t cell : shape.solid_cells) ++count[cell];
      EXPECT_EQ(count.size(), mesh->cells.size());
      for (const auto& [cell, n] : count) EXPECT_EQ(n, faces) << kind << ", cell " << cell;

      // The faces of every cell enclose its volume: by the divergence theorem with x/3, the cell's centre as origin.
      std::vector<Vec3<double>> x = places(shape, store);
      std::vector<Vec3<double>> centre(mesh->cells.size(), Vec3<double>{});
      std::vector<double> volume(mesh->cells.size(), 0.0);
      for (std::size_t c = 0; c < mesh->cells.size(); ++c) {
        const int corners = vertex_count(mesh->cells[c].kind);
        for (int k = 0; k < corners; ++k)
          centre[c] += (1.0 / corners) * mesh->nodes[static_cast<std::size_t>(mesh->cells[c].nodes[static_cast<std::size_t>(k)])];
      }
      const auto add = [&](const std::vector<std::uint32_t>& triangles, std::size_t t, std::uint32_t facet) {
        const std::size_t c = shape.solid_cells[facet];
        const Vec3<double> p = x[triangles[3 * t]] - centre[c], q = x[triangles[3 * t + 1]] - centre[c], r = x[triangles[3 * t + 2]] - centre[c];
        volume[c] += std::abs(dot(p, cross(q, r))) / 6;
      };
      for (std::size_t t = 0; t < shape.triangle_facets.size(); ++t) add(shape.triangles, t, shape.triangle_facets[t]);
      for (std::size_t t = 0; t < shape.inner_facets.size(); ++t) {
        add(shape.inner_triangles, t, shape.inner_facets[t]);
        add(shape.inner_triangles, t, shape.inner_facets[t] + 1);
      }
      for (const double v : volume) EXPECT_NEAR(v, 2.0 / static_cast<double>(mesh->cells.size()), tetrahedra ? 1e-2 : 1e-6);
      EXPECT_NEAR(std::accumulate(volume.begin(), volume.end(), 0.0), 2, 1e-6) << kind << order;
      EXPECT_TRUE(shape.note.empty()) << shape.note;
    }
}

TEST(PageGeometry, TheInsideOfALargeSolidIsLeftOutAndSaidSo) {
  const TemporaryDirectory directory;
  const auto mesh = generated("box", {{"size", {1, 1, 1}}, {"cells", {4, 4, 4}}}, {{"shape", "hexahedron"}});
  const Store store = stored(mesh, 1, {identity}, directory.path());
  const PageGeometry shape = page_geometry(store, {0}, 6 * 16 * 2 + 100);  // 6 x 16 outer and 3 x 48 inner faces of two triangles
  EXPECT_EQ(shape.triangle_facets.size(), 6U * 16 * 2);
  EXPECT_TRUE(shape.inner_triangles.empty());
  EXPECT_TRUE(shape.solid_cells.empty());
  EXPECT_NE(shape.note.find("inside of the solid is left out"), std::string::npos) << shape.note;
  EXPECT_EQ(page_geometry(store, {0}, 6 * 16 * 2 + 288).inner_facets.size(), 288U);
}

TEST(PageGeometry, CurvesAreCutWhereTheyBend) {
  const TemporaryDirectory directory;
  const auto arc = [](const Vec3<double>& x) { return std::vector<double>{std::sin(x[0]), 0, 1 - std::cos(x[0])}; };
  const auto mesh = generated("interval", {{"length", {2}}, {"cells", {5}}});
  const Store straight = stored(mesh, 1, {identity, arc}, directory.path());
  EXPECT_EQ(page_geometry(straight, {0, 1}, 1000).curves.size(), 10U);
  const Store bent = stored(mesh, 2, {identity, arc}, directory.path());
  const PageGeometry shape = page_geometry(bent, {0, 1}, 1000);
  EXPECT_GT(shape.curves.size(), 15U);
  EXPECT_EQ(shape.vertices.size(), shape.curves.size() - 4);  // neighbours share their ends
}

TEST(PageGeometry, AFilmTakesThePlaceOfTheFacesItLiesOn) {
  const TemporaryDirectory directory;
  const auto mesh = generated("box", {{"size", {2, 1, 1}}, {"cells", {4, 2, 2}}}, {{"shape", "hexahedron"}});
  OutputModel model;
  model.fields = {field_on(mesh, mesh->region("all"), "m", "R3", 1), field_on(mesh, mesh->region("top"), "Q", "SO3", 1)};
  model.deformation = 0;
  PageStates states(directory.path(), model);
  states.write(0, 0,
               OutputSampler(model).sample({{nodal(model.fields[0], identity), nodal(model.fields[1],
                                                                                     [](const auto&) {
                                                                                       return std::vector<double>{1, 0, 0, 0};
                                                                                     })},
                                            0}));
  const Store store = read_store(directory / "report.data");
  ASSERT_EQ(store.parts.size(), 2U);
  const PageGeometry shape = page_geometry(store, {0}, 200000);
  EXPECT_EQ(shape.triangle_facets.size(), 2U * 2 * (8 + 8 + 4));
  int film = 0;
  for (std::size_t k = 0; k < shape.facets.size(); ++k) {
    const PageFacet& f = shape.facets[k];
    if (f.part == 0) continue;
    ++film;
    EXPECT_EQ(f.below_part, 0);
    EXPECT_EQ(shape.solid_cells.at(k), static_cast<std::uint32_t>(f.below_cell));  // it is cut away with the cell it lies on
  }
  EXPECT_EQ(film, 8);
}

TEST(PageGeometry, MoreTrianglesThanAllowedAreThinnedAndSaidSo) {
  const TemporaryDirectory directory;
  const Store curved = stored(generated("sphere", {{"cells", {6}}, {"order", {2}}}), 2, {identity}, directory.path());
  EXPECT_TRUE(page_geometry(curved, {0}, 200000).note.empty());
  const PageGeometry coarser = page_geometry(curved, {0}, 1000);
  EXPECT_LE(coarser.triangle_facets.size(), 1000U);
  EXPECT_NE(coarser.note.find("at most 1 pieces"), std::string::npos) << coarser.note;
  const PageGeometry merged = page_geometry(curved, {0}, 300);
  EXPECT_LE(merged.triangle_facets.size(), 300U);
  EXPECT_GT(merged.triangle_facets.size(), 100U);
  EXPECT_NE(merged.note.find("of 720 triangles"), std::string::npos) << merged.note;
  EXPECT_NEAR(area(merged, places(merged, curved)), 4 * std::numbers::pi, 0.15 * 4 * std::numbers::pi);
}

TEST(Page, ATitleWithMarkupAndQuotesIsTextAndNothingElse) {
  const TemporaryDirectory directory;
  const std::string title = "A \"title\" </script><script>alert('x')</script> & more";
  write_summary(directory / "summary.json", summary_of(title));
  write_page(directory.path());
  const ReadPage page = read_page(directory.path());
  EXPECT_EQ(page.header.at("title"), title);
  EXPECT_EQ(page.header.at("result"), "It converged.");
  EXPECT_FALSE(page.header.contains("shape"));
  EXPECT_EQ(page.html.find("alert('x')</script>"), std::string::npos);
  EXPECT_NE(page.html.find("<title>A \"title\" &lt;/script&gt;&lt;script&gt;alert('x')&lt;/script&gt; &amp; more</title>"), std::string::npos);
  EXPECT_EQ(page.html.find("@KARCHER_"), std::string::npos);
}

TEST(Page, TheTemplateHoldsBothMarksOnce) {
  const std::string page(page_template());
  for (const std::string mark : {"@KARCHER_TITLE@", "@KARCHER_DATA@"}) {
    ASSERT_NE(page.find(mark), std::string::npos);
    EXPECT_EQ(page.find(mark), page.rfind(mark));
  }
}

TEST(Page, ShowsDisplacementsAngleToTheNormalAndDirectors) {
  const TemporaryDirectory directory;
  const auto mesh = generated("cylinder", {{"radius", {1}}, {"height", {2}}, {"cells", {12, 4}}, {"order", {2}}});
  OutputModel model;
  model.fields = {field_on(mesh, mesh->region("all"), "m", "R3", 2), field_on(mesh, mesh->region("all"), "Q", "SO3", 2)};
  model.deformation = 0;
  model.terms = {"cosserat-shell"};
  const OutputSampler output(model);
  PageStates states(directory.path(), model);
  const double angle = 0.7, c = std::cos(angle), s = std::sin(angle);
  const auto turn = [&](const Vec3<double>& x) { return std::vector<double>{x[0], c * x[1] - s * x[2], s * x[1] + c * x[2]}; };
  const auto turned = [&](const Vec3<double>&) { return std::vector<double>{std::cos(angle / 2), std::sin(angle / 2), 0, 0}; };
  const auto unturned = [](const Vec3<double>&) { return std::vector<double>{1, 0, 0, 0}; };
  states.write(0, 0, output.sample({{nodal(model.fields[0], identity), nodal(model.fields[1], unturned)}, 0}));
  states.write(1, 1, output.sample({{nodal(model.fields[0], turn), nodal(model.fields[1], turned)}, 1}), {{"cosserat-shell", 0.0}});
  states.write(2, 2, output.sample({{nodal(model.fields[0], turn), nodal(model.fields[1], unturned)}, 2}));
  write_summary(directory / "summary.json", summary_of("turned"));
  write_page(directory.path());
  const ReadPage page = read_page(directory.path());
  EXPECT_EQ(page.shape().at("states").size(), 3U);
  EXPECT_FALSE(page.shape().at("flat").get<bool>());
  // A director that turns with the surface stays on its normal; one that does not is off by up to the angle.
  const json normal = page.field("normal_angle");
  for (int k = 0; k < 3; ++k) {
    const std::vector<double> v = page.array(normal.at("arrays").at(static_cast<std::size_t>(k)));
    const double largest = *std::max_element(v.begin(), v.end());
    EXPECT_NEAR(largest, k < 2 ? 0 : angle * 180 / std::numbers::pi, 0.05) << k;
  }
  for (const double v : page.array(page.field("Q.angle").at("arrays").at(1))) EXPECT_NEAR(v, angle * 180 / std::numbers::pi, 1e-3);
  // Displacement at the vertices: of |x| sqrt(2 - 2 cos) in the yz plane.
  const std::vector<double> reference = page.array(page.shape().at("reference")), u = page.array(page.field("displacement").at("arrays").at(1));
  for (std::size_t i = 0; i < u.size(); ++i) {
    const double r = std::hypot(reference[3 * i + 1], reference[3 * i + 2]);
    EXPECT_NEAR(u[i], r * std::sqrt(2 - 2 * c), 1e-4);
  }
  const json glyphs = page.shape().at("glyphs").at(0);
  EXPECT_EQ(glyphs.at("kind"), "frame");
  const std::vector<double> q = page.array(glyphs.at("arrays").at(1));
  EXPECT_NEAR(std::abs(q[0]), std::sin(angle / 2), 1e-4);  // x, y, z, w
  EXPECT_NEAR(std::abs(q[3]), std::cos(angle / 2), 1e-4);
}

/// Lines through the origin as one of their two unit vectors, w first.
struct Lines : Sphere<2> {
  static constexpr std::string_view name = "lines";
  static Drawing drawing() { return {.glyph = Glyph::rod, .coordinates = {1, 2, 0}, .components = false}; }
};

TEST(Page, AManifoldIsDrawnAsItSays) {
  const TemporaryDirectory directory;
  const auto mesh = generated("rectangle", {{"size", {1, 1}}, {"cells", {2, 2}}}, {{"shape", "quadrilateral"}});
  OutputModel model;
  model.fields = {{"n", &manifold_ops<Lines>(), Rule::projection, std::make_shared<const Space>(mesh, mesh->region("all"), 1)}};
  PageStates states(directory.path(), model);
  states.write(0, 0,
               OutputSampler(model).sample({{nodal(model.fields[0],
                                                   [](const Vec3<double>&) {
                                                     return std::vector<double>{0.8, 0.6, 0};
                                                   })},
                                            0}));
  write_summary(directory / "summary.json", summary_of("rods"));
  write_page(directory.path());
  const ReadPage page = read_page(directory.path());
  const json glyphs = page.shape().at("glyphs").at(0);
  EXPECT_EQ(glyphs.at("kind"), "rod");
  const std::vector<double> rod = page.array(glyphs.at("arrays").at(0)), colour = page.array(page.field("n").at("arrays").at(0));
  const double expected[] = {0.6, 0, 0.8};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(rod.at(i), expected[i], 1e-6);
    EXPECT_NEAR(colour.at(i), expected[i], 1e-6);
  }
  EXPECT_EQ(page.field("n").at("kind"), "direction");
  EXPECT_THROW(page.field("n.1"), std::runtime_error);
  EXPECT_EQ(page.shape().at("start").at("glyphs"), "n");
}

TEST(Page, ShowsQuantitiesOfTermsWithTheirLegendsLeavesLoadsOutOfTheEnergyAndDrawsHeadlessDirectorsAsRods) {
  const TemporaryDirectory directory;
  const auto mesh = generated("rectangle", {{"size", {1, 1}}, {"cells", {3, 3}}}, {{"shape", "quadrilateral"}});
  OutputModel model;
  model.fields = {field_on(mesh, mesh->region("all"), "n", "S2", 1), field_on(mesh, mesh->region("all"), "u", "S2", 1)};
  model.terms = {"nematic", "weight"};
  model.loads = {"weight"};
  model.headless = {0};
  model.quantities = {{{"stress.N", "force/length", 2, "membrane force"}, {"charge", "1", 1, "topological charge"}}, {}};
  const std::vector<double> up = nodal(model.fields[0], [](const Vec3<double>&) { return std::vector<double>{0, 0, 1}; });
  std::vector<OutputPart> parts = OutputSampler(model).sample({{up, up}, 0});
  OutputArray stress{"stress.nematic.N", 2, {}};
  for (int c = 0; c < 9; ++c) stress.values.insert(stress.values.end(), {1.0 * c, -2.0 * c});
  parts.at(0).cell_data = {{"energy_density.nematic", 1, std::vector<double>(9, 2.0)},
                           {"energy_density.weight", 1, std::vector<double>(9, 5.0)},
                           stress,
                           {"charge.nematic", 1, std::vector<double>(9, 0.25)}};
  PageStates states(directory.path(), model);
  states.write(1, 1, parts);
  write_summary(directory / "summary.json", summary_of("quantities"));
  write_page(directory.path());
  const ReadPage page = read_page(directory.path());
  for (const double e : page.array(page.field("energy").at("arrays").at(0))) EXPECT_NEAR(e, 2, 1e-6);
  EXPECT_EQ(page.field("charge.nematic").at("label"), "topological charge");
  EXPECT_EQ(page.field("stress.nematic.N.2").at("label"), "membrane force (force/length), component 2");
  const std::vector<double> second = page.array(page.field("stress.nematic.N.2").at("arrays").at(0));
  for (std::size_t c = 0; c < 9; ++c) EXPECT_NEAR(second[c], -2.0 * static_cast<double>(c), 1e-3);
  std::map<std::string, std::string> kinds;
  for (const json& g : page.shape().at("glyphs")) kinds[g.at("name")] = g.at("kind");
  EXPECT_EQ(kinds, (std::map<std::string, std::string>{{"n", "rod"}, {"u", "arrow"}}));
}

TEST(Page, ValuesThatAreNotNumbersAreCountedAndKept) {
  const TemporaryDirectory directory;
  const auto mesh = generated("rectangle", {{"size", {1, 1}}, {"cells", {3, 3}}}, {{"shape", "quadrilateral"}});
  OutputModel model;
  model.fields = {field_on(mesh, mesh->region("all"), "u", "S2", 1)};
  model.terms = {"harmonic"};
  std::vector<double> values = nodal(model.fields[0], [](const Vec3<double>&) { return std::vector<double>{0, 0, 1}; });
  values[3 * 5] = NAN;
  std::vector<OutputPart> parts = OutputSampler(model).sample({{values}, 0});
  OutputArray density{"energy_density.harmonic", 1, std::vector<double>(9, 2.0)};
  density.values[4] = INFINITY;
  parts.at(0).cell_data = {density};
  PageStates states(directory.path(), model);
  states.write(1, 1, parts);
  write_summary(directory / "summary.json", summary_of("nan"));
  write_page(directory.path());
  const ReadPage page = read_page(directory.path());
  EXPECT_TRUE(page.shape().at("flat").get<bool>());
  EXPECT_EQ(page.field("u").at("not_finite"), 1);
  EXPECT_EQ(page.field("energy").at("not_finite"), 1);
  const std::vector<double> e = page.array(page.field("energy").at("arrays").at(0));
  EXPECT_EQ(std::count_if(e.begin(), e.end(), [](double v) { return std::isnan(v); }), 1);
  EXPECT_EQ(e[0], 2);
  EXPECT_EQ(page.shape().at("start").at("glyphs"), "u");
}

TEST(Page, OfManyCoordinatesNineAreShownAndFewerThanTheManifoldHasAreReadWithinTheirBounds) {
  const auto mesh = generated("interval", {{"cells", {3}}});
  for (const auto& [manifold, components] : {std::pair("Product", 20), {"SO3", 1}, {"SPD3", 2}}) {
    const TemporaryDirectory directory;
    OutputModel model;
    model.fields = {field_on(mesh, mesh->region("all"), "u", "R1", 1)};
    std::vector<OutputPart> parts =
        OutputSampler(model).sample({{nodal(model.fields[0], [](const Vec3<double>&) { return std::vector<double>{0}; })}, 0});
    OutputArray& array = parts.at(0).point_data.at(0);
    array.components = components;
    array.values.clear();
    for (std::size_t point = 0; point < parts[0].points.size(); ++point)
      for (int c = 0; c < components; ++c) array.values.push_back(c + 1);
    ManifoldOps ops;
    ops.name = manifold;
    model.fields[0].manifold = &ops;
    PageStates states(directory.path(), model);
    states.write(0, 0, parts);
    write_summary(directory / "summary.json", summary_of(manifold));
    write_page(directory.path());
    const ReadPage page = read_page(directory.path());
    if (components < 9) continue;
    for (int c = 1; c <= 9; ++c)
      for (const double v : page.array(page.field("u." + std::to_string(c)).at("arrays").at(0))) EXPECT_EQ(v, c);
    EXPECT_THROW(page.field("u.10"), std::runtime_error);
  }
}

TEST(Page, MoreStatesThanAllowedAreThinnedKeepingFirstAndLast) {
  const TemporaryDirectory directory;
  const auto mesh = generated("interval", {{"cells", {2}}});
  std::vector<std::function<std::vector<double>(const Vec3<double>&)>> maps(75, identity);
  stored(mesh, 1, maps, directory.path());
  write_summary(directory / "summary.json", summary_of("many"));
  write_page(directory.path());
  const ReadPage page = read_page(directory.path());
  const json& states = page.shape().at("states");
  ASSERT_EQ(states.size(), 60U);
  EXPECT_EQ(states.front().at("step"), 0);
  EXPECT_EQ(states.back().at("step"), 74);
  for (std::size_t k = 1; k < states.size(); ++k) EXPECT_LE(states[k].at("step").get<int>() - states[k - 1].at("step").get<int>(), 2);
  EXPECT_EQ(page.header.at("notes").at(0), "The page shows 60 of 75 states.");
}

TEST(PageStates, ARecordCutOffByAKillIsLeftOutAndSaidSo) {
  const TemporaryDirectory directory;
  const auto mesh = generated("interval", {{"cells", {3}}});
  stored(mesh, 1, {identity, identity, identity}, directory.path());
  const std::string whole = read_whole(directory / "report.data");
  write_summary(directory / "summary.json", summary_of("killed"));
  write_atomically(directory / "report.data", std::string_view(whole).substr(0, whole.size() - 5));
  write_page(directory.path());
  const ReadPage page = read_page(directory.path());
  EXPECT_EQ(page.shape().at("states").size(), 2U);
  EXPECT_NE(page.header.at("notes").dump().find("cut off"), std::string::npos);
  std::string damaged = whole;
  damaged[whole.size() - 8] = static_cast<char>(damaged[whole.size() - 8] + 1);
  write_atomically(directory / "report.data", damaged);
  EXPECT_EQ(read_store(directory / "report.data").states.size(), 2U);
}

TEST(PageStates, WhatNoDescriptionHoldsIsRefusedAlsoLengthsOfMoreBytesThan64BitsCount) {
  const TemporaryDirectory directory;
  const auto refusal = [&](const json& part, std::string_view numbers) -> std::string {
    const json description{
        {"machine", ""}, {"deformation", ""}, {"manifolds", json::object()}, {"terms", json::array()}, {"parts", json::array({part})}};
    write_atomically(directory / "report.data", std::string(store_magic) + record(description_record, description.dump(), numbers));
    try {
      read_store(directory / "report.data");
    } catch (const InputError& e) {
      return e.what();
    }
    return "accepted";
  };
  json part{{"region", "all"},           {"dim", 1}, {"order", 1}, {"points", 1}, {"cells", 0}, {"moves", false}, {"point_data", json::array()},
            {"cell_data", json::array()}};
  const std::string three_floats(12, '\0');
  EXPECT_EQ(refusal(part, three_floats), "accepted");
  // 3 * 6148914691236517206 = 2^64 + 2
  for (const std::uint64_t points : {std::uint64_t{2}, std::uint64_t{1} << 62, std::uint64_t{6148914691236517206}}) {
    part["points"] = points;
    EXPECT_NE(refusal(part, three_floats).find("was written by another version of Karcher"), std::string::npos) << points;
  }
  part["points"] = 1;
  part["order"] = 4;
  EXPECT_NE(refusal(part, three_floats).find("was written by another version of Karcher"), std::string::npos);
  part["order"] = 1;
  part["cells"] = 1;
  BinaryWriter line, quadrilateral;
  line.numbers<std::uint32_t>(std::vector<std::uint32_t>{static_cast<std::uint32_t>(CellKind::line), 0, 0});
  quadrilateral.numbers<std::uint32_t>(std::vector<std::uint32_t>{static_cast<std::uint32_t>(CellKind::quadrilateral), 0, 0, 0, 0});
  EXPECT_EQ(refusal(part, line.bytes() + three_floats), "accepted");
  EXPECT_NE(refusal(part, quadrilateral.bytes() + three_floats).find("was written by another version of Karcher"), std::string::npos);
  part["cells"] = std::uint64_t{1} << 62;
  EXPECT_NE(refusal(part, three_floats).find("was written by another version of Karcher"), std::string::npos);
}

TEST(PageStates, ADescriptionThatNamesTheManifoldIsReadAsItsDrawing) {
  const TemporaryDirectory directory;
  const auto read = [&](const std::string& manifold) {
    const json description = {
        {"machine", ""}, {"deformation", ""}, {"manifolds", {{"u", manifold}}}, {"terms", json::array()}, {"parts", json::array()}};
    write_atomically(directory / "report.data", std::string(store_magic) + record(description_record, description.dump(), {}));
    return read_store(directory / "report.data");
  };
  EXPECT_EQ(read("SPD2").drawings.at("u").glyph, Glyph::ellipsoid);
  EXPECT_THROW(read("of another program"), InputError);
}

TEST(PageStates, AResumedRunGoesOnAfterTheStatesItKeeps) {
  const TemporaryDirectory directory;
  const auto mesh = generated("interval", {{"cells", {3}}});
  stored(mesh, 1, {identity, identity, identity, identity}, directory.path());
  OutputModel model;
  model.fields = {field_on(mesh, mesh->region("all"), "m", "R3", 1)};
  model.deformation = 0;
  PageStates states(directory.path(), model, 2);
  EXPECT_EQ(read_store(directory / "report.data").states.size(), 2U);
  states.write(2, 0.5, OutputSampler(model).sample({{nodal(model.fields[0], identity)}, 0}), {{"load", 1.5}});
  const Store store = read_store(directory / "report.data");
  ASSERT_EQ(store.states.size(), 3U);
  EXPECT_EQ(store.states[2].t, 0.5);
  EXPECT_EQ(store.states[2].energies.at(0).second, 1.5);
  EXPECT_EQ(store.parts.size(), 1U);
}

TEST(Page, WithoutResultsOrWithForeignFilesItSaysWhatIsWrong) {
  const TemporaryDirectory directory;
  EXPECT_THROW(write_page(directory.path()), InputError);
  write_summary(directory / "summary.json", summary_of("x"));
  write_atomically(directory / "report.data", "something else");
  EXPECT_THROW(write_page(directory.path()), InputError);
  EXPECT_FALSE(std::filesystem::exists(directory / "report.html"));
}

}  // namespace
}  // namespace karcher
