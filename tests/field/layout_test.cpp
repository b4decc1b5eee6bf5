#include "karcher/field/layout.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <tuple>

#include "karcher/mesh/generators.hpp"
#include "karcher/mesh/partition.hpp"

namespace karcher {
namespace {

/// Fields (manifold, order) on a square of 5 by 4 quadrilaterals.
struct Square {
  std::shared_ptr<const Mesh> mesh = std::make_shared<const Mesh>(generate({"rectangle", {{"cells", {5, 4}}}, {}}));
  std::vector<Field> fields;
  std::vector<std::vector<char>> fixed;

  explicit Square(const std::vector<std::pair<const char*, int>>& wanted) {
    for (const auto& [manifold, order] : wanted) {
      fields.push_back({std::string(1, static_cast<char>('a' + fields.size())), &manifold_by_name(manifold), Rule::projection,
                        std::make_shared<Space>(mesh, mesh->region("all"), order)});
      fixed.emplace_back(static_cast<std::size_t>(fields.back().space->node_count() * fields.back().manifold->dim), 0);
    }
  }
  std::vector<Layout> on(int ranks) const {
    std::vector<Layout> layouts;
    for (int rank = 0; rank < ranks; ++rank) layouts.emplace_back(fields, fixed, partition_cells(*mesh, ranks), rank, ranks);
    return layouts;
  }
  int unknowns() const {
    int n = 0;
    for (const Field& f : fields) n += f.space->node_count() * f.manifold->dim;
    return n;
  }
};

/// (field, node, component) of every local dof.
std::vector<std::tuple<int, int, int>> meanings(const Layout& layout) {
  std::vector<std::tuple<int, int, int>> result(static_cast<std::size_t>(layout.local_dofs()), {-1, -1, -1});
  for (int f = 0; f < static_cast<int>(layout.fields().size()); ++f)
    for (int node : layout.local_nodes(f))
      for (int k = 0; k < layout.fields()[static_cast<std::size_t>(f)].manifold->dim; ++k) {
        auto& entry = result.at(static_cast<std::size_t>(layout.first_dof(f, node) + k));
        EXPECT_EQ(std::get<0>(entry), -1) << "two unknowns at one place";
        entry = {f, node, k};
      }
  return result;
}
int global_dof(const Layout& layout, int local) {
  return layout.local_to_global()[static_cast<std::size_t>(local / layout.block_size())] * layout.block_size() + local % layout.block_size();
}

TEST(Layout, BlocksHoldAllUnknownsOfAPlaceOrWhatDividesThoseOfEveryField) {
  EXPECT_EQ(Square({{"R3", 2}, {"SO3", 2}}).on(1)[0].block_size(), 6);
  EXPECT_EQ(Square({{"R3", 2}, {"SO3", 1}}).on(1)[0].block_size(), 3);
  EXPECT_EQ(Square({{"S2", 2}, {"R2", 1}}).on(1)[0].block_size(), 2);
  EXPECT_EQ(Square({{"R3", 2}, {"S2", 1}}).on(1)[0].block_size(), 1);
  EXPECT_EQ(Square({{"S2", 3}}).on(1)[0].block_size(), 2);
}

TEST(Layout, UnknownsOfOnePlaceAreNeighbours) {
  const Square s({{"R3", 2}, {"SO3", 1}});
  const Layout layout = s.on(1)[0];
  std::map<NodeKey, int> places;
  for (int n = 0; n < s.fields[0].space->node_count(); ++n) places[s.fields[0].space->key(n)] = layout.first_dof(0, n);
  for (int n = 0; n < s.fields[1].space->node_count(); ++n) EXPECT_EQ(layout.first_dof(1, n), places.at(s.fields[1].space->key(n)) + 3);
}

TEST(Layout, NumbersOneFieldInTheOrderOfItsNodes) {
  const Layout layout = Square({{"S2", 2}}).on(1)[0];
  for (int n = 0; n < layout.fields()[0].space->node_count(); ++n) EXPECT_EQ(layout.first_dof(0, n), 2 * n);
}

TEST(Layout, EveryUnknownHasOneOwnerAndOneGlobalNumberOnAllRanks) {
  for (const auto& square : {Square({{"R3", 2}, {"SO3", 2}}), Square({{"R3", 2}, {"S2", 1}}), Square({{"S2", 1}})})
    for (const int ranks : {1, 2, 3, 25}) {  // 25: some ranks have no cell
      std::map<std::tuple<int, int, int>, int> number, owner;
      int next_block = 0;
      for (const Layout& layout : square.on(ranks)) {
        EXPECT_EQ(layout.owned_begin(), next_block);
        next_block += layout.owned_blocks();
        EXPECT_EQ(layout.global_dofs(), square.unknowns());
        const auto meaning = meanings(layout);
        for (int d = 0; d < layout.local_dofs(); ++d) {
          const auto& m = meaning[static_cast<std::size_t>(d)];
          ASSERT_NE(std::get<0>(m), -1);
          EXPECT_EQ(number.emplace(m, global_dof(layout, d)).first->second, global_dof(layout, d));
          EXPECT_EQ(layout.owns(std::get<0>(m), std::get<1>(m)), d < layout.owned_dofs());
          if (d < layout.owned_dofs()) {
            EXPECT_TRUE(owner.emplace(m, layout.rank()).second);
            EXPECT_EQ(global_dof(layout, d), layout.owned_begin() * layout.block_size() + d);
          }
        }
        // owner() says the same on all ranks, also of nodes that this rank does not see.
        for (int f = 0; f < static_cast<int>(square.fields.size()); ++f)
          for (int n = 0; n < square.fields[static_cast<std::size_t>(f)].space->node_count(); ++n)
            EXPECT_EQ(layout.owner(f, n) == layout.rank(), layout.owns(f, n));
      }
      EXPECT_EQ(next_block * square.on(ranks)[0].block_size(), square.unknowns());
      EXPECT_EQ(number.size(), static_cast<std::size_t>(square.unknowns()));
      EXPECT_EQ(owner.size(), number.size());
    }
}

TEST(Layout, ARankSeesTheNodesOfItsCellsAndNoOthers) {
  const Square s({{"R3", 2}, {"S2", 1}});
  const CellRanks cell_ranks = partition_cells(*s.mesh, 3);
  for (const Layout& layout : s.on(3))
    for (int f : {0, 1}) {
      std::set<int> expected;
      const Space& space = *s.fields[static_cast<std::size_t>(f)].space;
      for (std::size_t c = 0; c < s.mesh->cells.size(); ++c)
        if (cell_ranks[c] == layout.rank())
          expected.insert(space.cell_nodes(static_cast<int>(c)).begin(), space.cell_nodes(static_cast<int>(c)).end());
      const std::vector<int>& seen = layout.local_nodes(f);
      EXPECT_EQ(std::set<int>(seen.begin(), seen.end()), expected);
      EXPECT_TRUE(std::is_sorted(seen.begin(), seen.end()));
      for (int n = 0; n < space.node_count(); ++n) EXPECT_EQ(layout.first_dof(f, n) >= 0, expected.contains(n));
    }
}

TEST(Layout, RanksShareTheUnknownsBetweenThem) {
  const auto layouts = Square({{"S2", 2}}).on(2);
  for (const Layout& layout : layouts) EXPECT_GT(layout.local_blocks(), layout.owned_blocks());  // each leaves some of the border to the other
}

TEST(Layout, FixedUnknownsKeepTheirPlacesAndAreNotCountedAsFree) {
  Square s({{"R3", 2}, {"S2", 1}});
  s.fixed[0][3 * 7 + 1] = s.fixed[0][3 * 7 + 2] = s.fixed[1][2 * 5] = 1;
  for (const int ranks : {1, 3})
    for (const Layout& layout : s.on(ranks)) {
      EXPECT_EQ(layout.free_dofs(), s.unknowns() - 3);
      const auto meaning = meanings(layout);
      for (int d = 0; d < layout.local_dofs(); ++d) {
        const auto& m = meaning[static_cast<std::size_t>(d)];
        EXPECT_EQ(layout.fixed(d), (m == std::tuple{0, 7, 1} || m == std::tuple{0, 7, 2} || m == std::tuple{1, 5, 0}));
      }
    }
  s.fixed = {{}, {}};  // nothing said: all free
  EXPECT_EQ(s.on(1)[0].free_dofs(), s.unknowns());
}

TEST(Layout, RetractsTheFreeComponentsOfTheNodesThatARankSees) {
  Square s({{"R3", 2}});
  for (std::size_t n = 0; n < s.fixed[0].size(); n += 4) s.fixed[0][n] = 1;
  for (const Layout& layout : s.on(2)) {
    Configuration from, to;
    from.t = 0.75;
    from.values.emplace_back(static_cast<std::size_t>(s.unknowns()));
    std::iota(from.values[0].begin(), from.values[0].end(), 0.0);
    to.values.emplace_back(from.values[0].size(), -1.0);
    std::vector<double> step;
    for (int d = 0; d < layout.local_dofs(); ++d) step.push_back(0.5 + global_dof(layout, d));
    layout.retract(from, step, to);
    EXPECT_EQ(to.t, 0.75);
    const auto& manifold = *s.fields[0].manifold;
    for (int n = 0; n < s.fields[0].space->node_count(); ++n)
      for (int k = 0; k < manifold.dim; ++k) {
        const auto at = static_cast<std::size_t>(3 * n + k);
        const int first = layout.first_dof(0, n);
        const double by = first < 0 || s.fixed[0][at] ? 0 : 0.5 + global_dof(layout, first + k);
        EXPECT_EQ(to.values[0][at], first < 0 ? -1 : from.values[0][at] + by);
      }
  }
}

TEST(Layout, AnEntityIsEvaluatedByTheRankOfTheFirstCellThatHasIt) {
  const Square s({{"R3", 2}});
  const CellRanks cell_ranks = partition_cells(*s.mesh, 3);
  const auto layouts = s.on(3);
  int shared = 0;
  for (const Cell& edge : entities(*s.mesh, 1, false)) {
    int expected = -1, last = -1;
    for (std::size_t c = 0; c < s.mesh->cells.size(); ++c) {
      const auto& nodes = s.mesh->cells[c].nodes;
      if (!std::all_of(edge.nodes.begin(), edge.nodes.end(), [&](int v) { return std::find(nodes.begin(), nodes.end(), v) != nodes.end(); }))
        continue;
      if (expected < 0) expected = cell_ranks[c];
      last = cell_ranks[c];
    }
    shared += expected != last;
    for (const Layout& layout : layouts) EXPECT_EQ(layout.cell_rank(edge), expected);
    for (int node : s.fields[0].space->entity_nodes(edge)) EXPECT_GE(layouts[static_cast<std::size_t>(expected)].first_dof(0, node), 0);
  }
  EXPECT_GT(shared, 3);
}

}  // namespace
}  // namespace karcher
