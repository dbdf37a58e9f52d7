// SPDX-License-Identifier: Apache-2.0
#include "tiles/source.hpp"

#include "tests/unit/tiles/tiles_support.hpp"
#include "tiles/parallel.hpp"

#include <cadt/errors.hpp>

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <fstream>
#include <functional>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <thread>

namespace cadt::tiles {
namespace {

std::vector<double> all_of(const PointSource& source, std::size_t step = 1000) {
  std::vector<double> xy(2 * source.size());
  for (std::uint64_t at = 0; at < source.size(); at += step)
    source.read(at, static_cast<std::size_t>(std::min<std::uint64_t>(step, source.size() - at)), xy.data() + 2 * at);
  return xy;
}

Hash128 content_of(const PointSource& source, unsigned threads) {
  std::vector<Hash128> hashes(64);
  BlockWork work;
  work.look = [&](unsigned thread, std::uint64_t first, std::span<const double> xy) {
    add_block_hash(hashes[thread], first, xy);
  };
  each_block(source, 0, source.size(), threads, {}, work);
  Hash128 sum;
  for (const Hash128& h : hashes) sum.high += h.high, sum.low += h.low;
  return sum;
}

TEST(Source, FilesOfEveryFormat) {
  const Folder folder;
  io::PointSet points;
  points.xy = points_of("gaussian", 777);
  for (const std::string& format : io::point_write_formats()) {
    SCOPED_TRACE(format);
    io::write_points(folder / ("p." + format), points);
    const auto source = open_file(folder / ("p." + format));
    EXPECT_EQ(all_of(*source, 100), io::read_points(folder / ("p." + format)).xy);
    const bool by_range = format == "npy" || format == "f64" || format == "f32";
    EXPECT_EQ(source->memory() == 0, by_range);
    EXPECT_EQ(source->name_of(3), folder / ("p." + format));
  }
}

TEST(Source, ArraysWithHeightsAndOtherForms) {
  const Folder folder;
  io::PointSet points;
  points.xy = points_of("gaussian", 50);
  points.height = std::vector<double>(50, 3.5);
  points.height[7] = -1;
  io::write_points(folder / "p.npy", points);
  for (const io::Projection projection : {io::Projection::xy, io::Projection::yz, io::Projection::zx}) {
    io::ReadOptions options;
    options.projection = projection;
    const auto source = open_file(folder / "p.npy", options);
    EXPECT_EQ(source->memory(), 0U);
    EXPECT_EQ(all_of(*source), io::read_points(folder / "p.npy", options).xy);
  }
  // Fortran's order is left to the reader of whole files.
  std::ofstream file(folder / "f.npy", std::ios::binary);
  std::string header = "{'descr': '<f8', 'fortran_order': True, 'shape': (2, 2), }";
  header.append(127 - 10 - header.size(), ' ').append("\n");
  file << std::string("\x93NUMPY\x01\x00", 8) << static_cast<char>(header.size()) << '\0' << header;
  for (const double v : {1.0, 2.0, 3.0, 4.0}) file.write(reinterpret_cast<const char*>(&v), sizeof v);
  file.close();
  EXPECT_EQ(all_of(*open_file(folder / "f.npy")), (std::vector<double>{1, 3, 2, 4}));
}

TEST(Source, WrongFiles) {
  const Folder folder;
  EXPECT_THROW((void)open_file(folder / "none.npy"), io::FileError);
  std::ofstream(folder / "odd.f64") << "12345678901234567890";
  EXPECT_THROW((void)open_file(folder / "odd.f64"), io::FileError);
  std::ofstream(folder / "bad.npy") << "not an array";
  EXPECT_THROW((void)open_file(folder / "bad.npy"), io::FileError);
  io::PointSet points;
  points.xy = points_of("uniform", 100);
  io::write_points(folder / "p.f64", points);
  const auto source = open_file(folder / "p.f64");
  std::filesystem::resize_file(folder / "p.f64", 800);
  EXPECT_THROW((void)all_of(*source), io::FileError);
}

TEST(Source, GeneratedByRange) {
  for (const io::Distribution& about : io::distributions()) {
    SCOPED_TRACE(about.name);
    io::GenerateOptions options;
    options.n = 900;
    options.seed = 5;
    const auto source = generated(std::string(about.name), options);
    EXPECT_EQ(source->memory() == 0, about.by_range || source->cells() != nullptr);
    std::vector<double> expected = io::generate(about.name, options).xy;
    for (double& v : expected) v += 0.0;
    EXPECT_EQ(all_of(*source, 70), expected);
    options.first = 1;
    if (!about.by_range) {
      EXPECT_THROW((void)io::generate(about.name, options), std::invalid_argument);
    }
  }
}

TEST(Source, Concatenation) {
  const std::vector<double> xy = points_of("uniform", 1000);
  std::vector<std::unique_ptr<PointSource>> parts;
  std::size_t begin = 0;
  for (const std::size_t end : {1, 1, 2, 300, 999, 1000}) {
    parts.push_back(in_memory(
        {xy.begin() + static_cast<std::ptrdiff_t>(2 * begin), xy.begin() + static_cast<std::ptrdiff_t>(2 * end)},
        "part " + std::to_string(parts.size())));
    begin = end;
  }
  const auto source = concatenate(std::move(parts));
  EXPECT_EQ(all_of(*source, 77), xy);
  EXPECT_EQ(all_of(*source, 1), xy);
  EXPECT_EQ(source->name_of(0), "part 0");
  EXPECT_EQ(source->name_of(1), "part 2");
  EXPECT_EQ(source->name_of(999), "part 5");
  EXPECT_EQ(source->index_in_part(300), 0U);
  EXPECT_EQ(source->index_in_part(299), 297U);
}

TEST(Source, NegativeZeroIsZero) {
  const std::vector<double> xy = all_of(*in_memory({-0.0, 1, 2, -0.0}));
  EXPECT_FALSE(std::signbit(xy[0]));
  EXPECT_FALSE(std::signbit(xy[3]));
}

TEST(Source, FirstPointThatIsNotFinite) {
  std::vector<double> xy = points_of("uniform", 5 * block_points);
  xy[2 * 3 * block_points + 9] = std::numeric_limits<double>::infinity();
  xy[2 * 2 * block_points + 11] = std::numeric_limits<double>::quiet_NaN();
  xy[2 * 4 * block_points] = std::numeric_limits<double>::quiet_NaN();
  std::vector<std::unique_ptr<PointSource>> parts;
  parts.push_back(in_memory({xy.begin(), xy.begin() + 200}, "first"));
  parts.push_back(in_memory({xy.begin() + 200, xy.end()}, "second"));
  const auto source = concatenate(std::move(parts));
  for (const unsigned threads : {1U, 3U, 8U}) {
    try {
      (void)content_of(*source, threads);
      FAIL() << "no error";
    } catch (const InputError& e) {
      EXPECT_EQ(e.index(), 2 * block_points + 5);
      EXPECT_NE(std::string(e.what()).find("second: point " + std::to_string(2 * block_points + 5 - 100)),
                std::string::npos)
          << e.what();
      EXPECT_NE(std::string(e.what()).find("NaN"), std::string::npos);
    }
  }
}

TEST(Source, HashOfContent) {
  const std::vector<double> xy = points_of("uniform", 3 * block_points + 17);
  const Hash128 hash = content_of(*in_memory(xy), 1);
  EXPECT_EQ(content_of(*in_memory(xy), 3), hash);
  std::vector<std::unique_ptr<PointSource>> parts;
  parts.push_back(in_memory({xy.begin(), xy.begin() + 20002}));
  parts.push_back(in_memory({xy.begin() + 20002, xy.end()}));
  EXPECT_EQ(content_of(*concatenate(std::move(parts)), 2), hash);
  std::vector<double> other = xy;
  std::swap_ranges(other.begin(), other.begin() + 2 * block_points, other.begin() + 2 * block_points);
  EXPECT_NE(content_of(*in_memory(other), 1), hash) << "the order counts";
}

TEST(Source, TurnsComeInOrderAndErrorsOut) {
  const std::vector<double> xy = points_of("uniform", 9 * block_points + 3);
  for (const unsigned threads : {1U, 2U, 5U, 20U}) {
    SCOPED_TRACE(threads);
    std::vector<double> seen(xy.size());
    std::vector<std::span<const double>> block(32);
    std::vector<std::uint64_t> first(32), order;
    BlockWork work;
    work.look = [&](unsigned thread, std::uint64_t at, std::span<const double> points) {
      if (at % (3 * block_points) == 0) std::this_thread::sleep_for(std::chrono::milliseconds(2));
      block[thread] = points, first[thread] = at;
    };
    work.in_turn = [&](unsigned thread) { order.push_back(first[thread]); };
    work.then = [&](unsigned thread) {
      std::copy(block[thread].begin(), block[thread].end(),
                seen.begin() + static_cast<std::ptrdiff_t>(2 * first[thread]));
    };
    each_block(*in_memory(xy), 0, xy.size() / 2, threads, {}, work);
    EXPECT_EQ(seen, xy);
    ASSERT_EQ(order.size(), 10U);
    for (std::size_t i = 0; i < order.size(); ++i) EXPECT_EQ(order[i], i * block_points);
    // An error ends all, whoever waits for its turn.
    order.clear();
    const auto failing = [&](std::uint64_t at) {
      if (at == 4 * block_points) throw std::logic_error("x");
    };
    BlockWork bad = work;
    bad.look = [&](unsigned thread, std::uint64_t at, std::span<const double> points) {
      work.look(thread, at, points);
      failing(at);
    };
    EXPECT_THROW(each_block(*in_memory(xy), 0, xy.size() / 2, threads, {}, bad), std::logic_error);
    EXPECT_LE(order.size(), 4U);
    bad = work;
    bad.in_turn = [&](unsigned thread) { failing(first[thread]); };
    EXPECT_THROW(each_block(*in_memory(xy), 0, xy.size() / 2, threads, {}, bad), std::logic_error);
    cadt::stop_source stop;
    stop.request_stop();
    EXPECT_THROW(each_block(*in_memory(xy), 0, xy.size() / 2, threads, stop.get_token(), work), Cancelled);
  }
}

TEST(Tasks, AllAreRunAndTheFirstErrorIsThrown) {
  for (const unsigned threads : {1U, 3U, 50U}) {
    std::vector<int> runs(20);
    std::vector<std::function<void()>> tasks;
    for (std::size_t i = 0; i < runs.size(); ++i) {
      tasks.emplace_back([&runs, i] {
        ++runs[i];
        if (i == 7 || i == 13) throw InputError("x", i);
      });
    }
    try {
      run_tasks(tasks, threads);
      FAIL() << "no error";
    } catch (const InputError& e) {
      EXPECT_EQ(e.index(), 7U);
    }
    EXPECT_EQ(runs, std::vector<int>(20, 1));
    EXPECT_NO_THROW(run_tasks({}, threads));
  }
}

}  // namespace
}  // namespace cadt::tiles
