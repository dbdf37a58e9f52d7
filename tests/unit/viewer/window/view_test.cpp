// SPDX-License-Identifier: Apache-2.0
// Commands, their keys, and what they do to the view.
#include "viewer/window/view.hpp"

#include <gtest/gtest.h>

#include <map>
#include <set>
#include <string>
#include <string_view>

namespace cadt::viewer {
namespace {

ViewState shown() {
  ViewState view;
  view.resize(800, 600);
  view.show(Extent{{0, 0}, {1, 1}}, 1000, false);
  return view;
}

TEST(Commands, HaveKeysThatNoOtherHas) {
  std::map<char, Command> of_character;
  for (const Binding& b : bindings()) {
    EXPECT_FALSE(b.characters.empty() && b.keys.empty()) << b.name;
    for (const char c : b.characters) {
      EXPECT_TRUE(of_character.emplace(c, b.command).second) << c << " asks for " << b.name << " and another";
      EXPECT_EQ(command_of(static_cast<char32_t>(c)), b.command);
    }
    for (const Key& key : b.keys) EXPECT_EQ(command_of(key), b.command) << b.name;
  }
}

TEST(Commands, AreThoseOfBothCases) {
  for (const char32_t c : std::u32string_view(U"fchvdirgetmpq"))
    EXPECT_EQ(command_of(c), command_of(c - 32)) << static_cast<char>(c);
}

TEST(Commands, AreAllInTheTable) {
  std::set<Command> all;
  for (const Binding& b : bindings()) EXPECT_TRUE(all.insert(b.command).second) << b.name;
  EXPECT_EQ(all.size(), static_cast<std::size_t>(Command::quit) + 1);
  EXPECT_FALSE(command_of(U'\u00e4'));
  EXPECT_FALSE(command_of(Key{12345, 0}));
}

TEST(View, ZoomsToTheCursor) {
  ViewState view = shown();
  const auto before = view.camera.place(200, 150);
  view.wheel(3, 200, 150);
  EXPECT_GT(view.camera.magnification(), 1.7);
  const auto after = view.camera.place(200, 150);
  EXPECT_NEAR(after[0], before[0], 1e-12);
  EXPECT_NEAR(after[1], before[1], 1e-12);
}

TEST(View, StaysWithOtherPoints) {
  ViewState view = shown();
  view.wheel(3, 200, 150);
  const auto low = view.camera.place(0, 600), high = view.camera.place(800, 0);
  view.renew(Extent{{-2, 0}, {1, 5}}, 500);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_NEAR(view.camera.place(0, 600)[k], low[k], 1e-9);
    EXPECT_NEAR(view.camera.place(800, 0)[k], high[k], 1e-9);
  }
  view.go_to(-2, 5, 0.01);
  EXPECT_NEAR(view.camera.place(400, 300)[0], -2, 1e-9);
  ASSERT_TRUE(view.apply(Command::fit));
  const auto corner = view.camera.pixel(-2, 5);
  EXPECT_TRUE(corner[0] > 0 && corner[1] > 0 && corner[1] < 20) << "all of them are seen";
}

TEST(View, ArrowsMoveAndFitComesBack) {
  ViewState view = shown();
  ASSERT_TRUE(view.apply(Command::zoom_in));
  const auto pixel = view.camera.pixel(0.5, 0.5);
  ASSERT_TRUE(view.apply(Command::pan_left));  // what is left comes into view: all moves to the right
  EXPECT_NEAR(view.camera.pixel(0.5, 0.5)[0], pixel[0] + 60, 1e-9);
  ASSERT_TRUE(view.apply(Command::pan_up));
  EXPECT_NEAR(view.camera.pixel(0.5, 0.5)[1], pixel[1] + 60, 1e-9);
  ASSERT_TRUE(view.apply(Command::fit));
  EXPECT_EQ(view.camera.magnification(), 1.0);
  EXPECT_NEAR(view.camera.pixel(0.5, 0.5)[0], 400, 1e-9);
}

TEST(View, ColoursFollowWhatThereIs) {
  ViewState view = shown();
  std::set<ColourBy> seen;
  for (std::size_t i = 0; i < view.colours.size(); ++i) {
    view.apply(Command::next_colour);
    seen.insert(view.colour);
  }
  EXPECT_EQ(seen.size(), view.colours.size());
  EXPECT_FALSE(seen.contains(ColourBy::height));
  view.show(Extent{{0, 0}, {1, 1}}, 1000, true);
  EXPECT_EQ(view.colours.back(), ColourBy::height);
  view.colour = ColourBy::height;
  view.show(Extent{{0, 0}, {1, 1}}, 1000, false);
  EXPECT_EQ(view.colour, ColourBy::area) << "these points have no heights";
}

TEST(View, DrawsPointsWireframeAndFilled) {
  ViewState view = shown();
  view.apply(Command::points);
  EXPECT_TRUE(view.style().points_alone);
  view.apply(Command::wireframe);
  EXPECT_FALSE(view.style().points_alone);
  EXPECT_FALSE(view.style().fill);
  view.apply(Command::filled);
  EXPECT_TRUE(view.style().fill);
  view.apply(Command::dark);
  EXPECT_TRUE(view.style().dark);
  for (const Drawing d : {Drawing::points, Drawing::wireframe, Drawing::filled})
    EXPECT_EQ(drawing_from_string(to_string(d)), d);
  EXPECT_FALSE(drawing_from_string("solid"));
}

TEST(View, VerticesAreDrawnWhereTheyAreFarApart) {
  ViewState view = shown();
  view.show(Extent{{0, 0}, {1, 1}}, 100'000, false);
  EXPECT_EQ(view.style().point_radius, 0);
  view.wheel(20, 400, 300);
  EXPECT_GT(view.style().point_radius, 1);
}

TEST(View, GoesToATriangle) {
  ViewState view = shown();
  view.go_to(0.25, 0.75, 0.001);
  const auto middle = view.camera.place(400, 300);
  EXPECT_NEAR(middle[0], 0.25, 1e-9);
  EXPECT_NEAR(middle[1], 0.75, 1e-9);
  EXPECT_NEAR(0.001 * view.camera.scale(), 200, 1);
  view.apply(Command::fit);
  view.go_to(0.25, 0.75, 0);  // a point
  EXPECT_GE(view.camera.magnification(), 8);
}

TEST(View, StaysWhereItIsInAnotherSize) {
  ViewState view = shown();
  view.go_to(0.25, 0.75, 0.01);
  view.resize(1200, 500);
  EXPECT_NEAR(view.camera.place(600, 250)[0], 0.25, 1e-9);
}

TEST(Search, UnderstandsIndices) {
  const auto found = [](std::string_view text, bool points = false) {
    const auto s = parse_search(text, points);
    return s ? (s->point ? "p" : "t") + std::to_string(s->index) : std::string("none");
  };
  EXPECT_EQ(found("12"), "t12");
  EXPECT_EQ(found("12", true), "p12");
  EXPECT_EQ(found(" p 7 "), "p7");
  EXPECT_EQ(found("Point 7"), "p7");
  EXPECT_EQ(found("t7"), "t7");
  EXPECT_EQ(found("triangle 0"), "t0");
  for (const char* wrong : {"", "p", "x 3", "3 4", "-1", "1.5", "99999999999999999999999"})
    EXPECT_EQ(found(wrong), "none") << wrong;
}

}  // namespace
}  // namespace cadt::viewer
