// SPDX-License-Identifier: Apache-2.0
// What is done on a thread, what can go wrong there, and how that is said.
#include "viewer/window/work.hpp"
#include "viewer/gl/errors.hpp"
#include "viewer/window/message.hpp"
#include "viewer/window/screenshot.hpp"
#include "viewer/window/source.hpp"

#include <cadt/io/errors.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <fstream>
#include <new>
#include <thread>

namespace cadt::viewer {
namespace {

std::exception_ptr wait_for(Work& work) {
  std::exception_ptr error;
  while (!work.finished(error)) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  return error;
}

template <class Error>
bool is_a(const std::exception_ptr& error) {
  try {
    if (error) std::rethrow_exception(error);
  } catch (const Error&) {
    return true;
  } catch (...) {
  }
  return false;
}

Source generated(std::size_t n) {
  Source source;
  source.generate.n = n;
  return source;
}

TEST(WorkTest, ReportsAndEnds) {
  std::atomic<int> woken{0};
  Work work([&] { ++woken; });
  std::atomic<bool> go{false};
  work.start([&](Work::Desk& desk) {
    desk.report("half", 0.5);
    while (!go) std::this_thread::yield();
  });
  while (work.state().phase != "half") std::this_thread::yield();
  EXPECT_EQ(work.state().fraction, 0.5);
  EXPECT_TRUE(work.running());
  go = true;
  EXPECT_FALSE(wait_for(work));
  EXPECT_FALSE(work.running());
  EXPECT_GE(woken, 1);
}

TEST(WorkTest, IsCancelled) {
  Work work([] {});
  work.start([](Work::Desk& desk) {
    for (;;) desk.check();
  });
  work.cancel();
  EXPECT_TRUE(is_a<Cancelled>(wait_for(work)));
}

TEST(Load, TriangulatesAGeneratedSet) {
  Work work([] {});
  std::shared_ptr<Loaded> loaded;
  Triangulators triangulators;
  Options options;
  options.backend = Backend::host;
  work.start([&](Work::Desk& desk) { loaded = load(generated(1000), options, &triangulators, 0, desk); });
  ASSERT_FALSE(wait_for(work));
  EXPECT_EQ(loaded->points.size(), 1000u);
  ASSERT_TRUE(loaded->mesh);
  EXPECT_EQ(loaded->mesh->hash(), triangulate(loaded->points.view(), options).hash());
  EXPECT_EQ(loaded->device.backend, Backend::host);
}

TEST(Load, TriangulatesPointsWithSegments) {
  // A square with a square hole: the triangles around it, in a ring.
  const std::vector<double> xy{0, 0, 3, 0, 3, 3, 0, 3, 1, 1, 2, 1, 2, 2, 1, 2};
  const std::vector<Segment> rings{{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6}, {6, 7}, {7, 4}};
  Source source;
  source.path = "plate.poly";
  ConstraintOptions constraints;
  constraints.domain = Domain::even_odd;
  source.constrain = [&](const Options& options) {
    return Constrained{{.xy = xy, .height = std::vector<double>(8, 1.0), .format = {}},
                       triangulate_constrained(std::span<const double>(xy), rings, constraints, options)};
  };
  std::shared_ptr<Loaded> loaded;
  Work work([] {});
  work.start([&](Work::Desk& desk) { loaded = load(source, {}, nullptr, 0, desk); });
  ASSERT_FALSE(wait_for(work));
  ASSERT_TRUE(loaded->mesh && loaded->inside);
  EXPECT_EQ(loaded->heights.size(), 8u);
  const auto triangles = loaded->triangles(), neighbours = loaded->neighbors();
  ASSERT_EQ(triangles.size(), 24u);
  ASSERT_EQ(neighbours.size(), 24u);
  for (std::size_t t = 0; t < 8; ++t) {
    int known = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t other = neighbours[3 * t + k];
      if (other < 0) continue;
      ++known;
      for (const std::size_t j : {(k + 1) % 3, (k + 2) % 3}) {  // both ends of the edge between them
        const auto corners = triangles.subspan(3 * static_cast<std::size_t>(other), 3);
        EXPECT_NE(std::ranges::find(corners, triangles[3 * t + j]), corners.end()) << t << ' ' << other;
      }
    }
    EXPECT_EQ(known, 2) << t;
  }
  const io::picture::Scene scene = loaded->scene();
  EXPECT_EQ(scene.segments.size(), 8u);
  EXPECT_EQ(scene.region.size(), 8u);
  EXPECT_TRUE(scene.hull.empty());
}

TEST(Load, ATriangulationIsCancelled) {
  Work work([] {});
  Triangulators triangulators;
  Options options;
  options.backend = Backend::host;
  work.start(
      [&](Work::Desk& desk) { static_cast<void>(load(generated(3'000'000), options, &triangulators, 0, desk)); });
  work.cancel();
  EXPECT_TRUE(is_a<Cancelled>(wait_for(work)));
}

TEST(Load, RefusesBeforeAnyMemoryIsTaken) {
  Triangulators triangulators;
  Options options;
  options.backend = Backend::host;
  Work work([] {});
  work.start(
      [&](Work::Desk& desk) { static_cast<void>(load(generated(1'000'000'000), options, &triangulators, 0, desk)); });
  EXPECT_TRUE(is_a<LimitError>(wait_for(work)));
  work.start([&](Work::Desk& desk) {
    static_cast<void>(load(generated(500'000'000), options, &triangulators, std::size_t{8} << 30, desk));
  });
  const std::exception_ptr error = wait_for(work);
  EXPECT_TRUE(is_a<OutOfMemory>(error));
  const Message message = explain(error);
  EXPECT_NE(message.text.find("500,000,000 points do not fit"), std::string::npos) << message.text;
  EXPECT_NE(message.text.find("Available: 8.0 GiB"), std::string::npos) << message.text;
}

TEST(Load, AFileThatIsNoneIsExplained) {
  const auto path = std::filesystem::temp_directory_path() / "cadt-window-test.xy";
  std::ofstream(path) << "1 2\nthis is no number\n";
  Source source;
  source.path = path.string();
  Work work([] {});
  work.start([&](Work::Desk& desk) { static_cast<void>(load(source, {}, nullptr, 0, desk)); });
  const std::exception_ptr error = wait_for(work);
  std::filesystem::remove(path);
  const Message message = explain(error);
  EXPECT_EQ(message.title, "This file cannot be shown");
  EXPECT_NE(message.text.find(":2"), std::string::npos) << message.text;
  EXPECT_NE(message.advice.find("xyz"), std::string::npos) << message.advice;
}

TEST(Messages, SayWhatToDo) {
  const std::vector<std::exception_ptr> all{std::make_exception_ptr(InputError("NaN", 3)),
                                            std::make_exception_ptr(LimitError("many", 2, 1)),
                                            std::make_exception_ptr(OptionError("threads", "?")),
                                            std::make_exception_ptr(BackendUnavailable("cuda", "none")),
                                            std::make_exception_ptr(KernelBuildError("d", "o", "l")),
                                            std::make_exception_ptr(DeviceError("c", 1, "d", "t")),
                                            std::make_exception_ptr(OutOfMemory("m", 2, 1)),
                                            std::make_exception_ptr(Cancelled()),
                                            std::make_exception_ptr(std::bad_alloc()),
                                            std::make_exception_ptr(std::runtime_error("x")),
                                            std::make_exception_ptr(io::FileError("f", 1, "m")),
                                            std::make_exception_ptr(3)};
  for (const auto& error : all) {
    const Message message = explain(error);
    EXPECT_FALSE(message.title.empty());
    EXPECT_FALSE(message.text.empty());
    EXPECT_FALSE(message.advice.empty()) << message.title;
  }
  EXPECT_FALSE(explain(std::make_exception_ptr(Cancelled())).error);
  EXPECT_EQ(explain(std::make_exception_ptr(DisplayError("no GL: install it"))).text, "no GL: install it");
}

TEST(Numbers, AreWrittenAndRead) {
  EXPECT_EQ(number_text(0), "0");
  EXPECT_EQ(number_text(999), "999");
  EXPECT_EQ(number_text(1234567), "1,234,567");
  EXPECT_EQ(parse_number("250,000"), 250000u);
  EXPECT_EQ(parse_number("1.5M"), 1500000u);
  EXPECT_EQ(parse_number("1e6"), 1000000u);
  for (const char* wrong : {"", "x", "1.5", "-3", "1 K K", "nan", "1e30"})
    EXPECT_THROW(static_cast<void>(parse_number(wrong)), std::invalid_argument) << wrong;
}

TEST(Screenshots, NeverOverwrite) {
  const auto before = std::filesystem::current_path();
  const auto folder = std::filesystem::temp_directory_path() / "cadt-screenshot-test";
  std::filesystem::remove_all(folder);  // of a run that did not end
  std::filesystem::create_directory(folder);
  std::filesystem::current_path(folder);
  EXPECT_EQ(free_picture_name("mesh"), "mesh-1.png");
  std::ofstream("mesh-1.png") << "mine";
  std::filesystem::create_symlink("nowhere", "mesh-2.png");
  EXPECT_EQ(free_picture_name("mesh"), "mesh-3.png");
  std::filesystem::current_path(before);
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace cadt::viewer
