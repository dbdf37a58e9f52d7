// SPDX-License-Identifier: Apache-2.0
// Constrained edges before the verifier: they need not be Delaunay, and both triangles must say that they are.
#include "devices.hpp"
#include "rejection.hpp"
#include "small_delaunay.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace {

using cadt::MeshView;

/// Two triangles with the wrong diagonal of a quadrilateral, 0-2.
struct WrongDiagonal {
  std::vector<double> xy = {0, 0, 2, -1, 5, 0, 2, 1};
  std::vector<std::int32_t> triangles = {0, 1, 2, 0, 2, 3}, neighbors = {-1, 1, -1, -1, -1, 0};
  std::vector<std::uint32_t> flags = {2, 4};

  [[nodiscard]] cadt::VerifyReport report() const {
    MeshView view;
    view.triangles = triangles;
    view.neighbors = neighbors;
    view.edge_flags = flags;
    return on_host_and_devices(std::span<const double>(xy), view);
  }
};

std::string failures(const cadt::VerifyReport& report) {
  for (const cadt::Check& check : report.checks)
    if (!check.passed) return check.name;
  return {};
}

TEST(ConstrainedEdges, NeedNotBeDelaunay) {
  WrongDiagonal mesh;
  const cadt::VerifyReport report = mesh.report();
  EXPECT_TRUE(report.ok) << report.summary();
  EXPECT_EQ(report.edges_examined, 1U);
  mesh.flags = {0, 0};
  EXPECT_EQ(failures(mesh.report()), "delaunay");
  mesh.flags = {1, 3};  // others
  EXPECT_EQ(failures(mesh.report()), "delaunay");
}

TEST(ConstrainedEdges, AreSaidByBothTriangles) {
  WrongDiagonal mesh;
  for (const std::array<std::uint32_t, 2>& flags : {std::array{2U, 0U}, {0U, 4U}, {2U, 2U}, {4U, 4U}}) {
    mesh.flags.assign(flags.begin(), flags.end());
    EXPECT_EQ(failures(mesh.report()), "neighbors") << flags[0] << ' ' << flags[1];
  }
}

TEST(ConstrainedEdges, HaveAWordForEachTriangle) {
  WrongDiagonal mesh;
  mesh.flags.push_back(0);
  EXPECT_EQ(failures(mesh.report()), "counts");
}

}  // namespace
