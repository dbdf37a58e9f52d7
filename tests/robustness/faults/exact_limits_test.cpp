// SPDX-License-Identifier: Apache-2.0
// Limits to the byte: what just fits is done, with one byte less the call is refused before any work, and the error
// says what is needed and what there is. Groups of a batch to the point and to the set.
#include "tests/robustness/faults/faulty_device.hpp"
#include "tests/system/resident/resident.hpp"

#include <sys/mman.h>

#include <cstring>

#include "common/driver/device_text.hpp"

namespace cadt::test {
namespace {

using namespace device_text;
using Reals = std::span<const double>;
using Work = std::function<void(Triangulator&)>;

class ExactLimits : public ResidentTest {
 protected:
  [[nodiscard]] Options options(Strategy strategy) const {
    Options with = ResidentTest::options();
    with.tuning.strategy = strategy;
    return with;
  }
  [[nodiscard]] bool on_host_itself() const { return GetParam().backend == Backend::host; }

  void expect_refused(const Options& with, const Work& call, std::size_t needed, std::size_t available) {
    Triangulator triangulator(with);
    faults->clear();
    const auto error = thrown<OutOfMemory>([&] { call(triangulator); });
    ASSERT_NE(error, nullptr);
    EXPECT_EQ(error->needed(), needed);
    EXPECT_EQ(error->available(), available);
    EXPECT_EQ(faults->count(Step::launch), 0U);
    EXPECT_EQ(faults->count(Step::allocation), 0U);
  }

  /// So many bytes as a bound of the caller's, and as all that the device has: then the call is not refused, but
  /// buffers that wait for a later phase or call take more, `waiting` in all.
  void expect_exact(Options with, const Work& call, std::size_t bytes, std::size_t waiting) {
    with.max_memory = bytes - 1;
    expect_refused(with, call, bytes, bytes - 1);
    with.max_memory = bytes;
    {
      Triangulator triangulator(with);
      faults->clear();
      call(triangulator);
      EXPECT_LE(faults->most_bytes(), bytes);
    }
    with.max_memory = 0;
    faults->device_bytes = bytes - 1;
    expect_refused(with, call, bytes, bytes - 1);
    faults->device_bytes = waiting;
    {
      Triangulator triangulator(with);
      call(triangulator);
    }
    faults->device_bytes = 0;
  }

  /// The largest buffer that the device makes.
  void expect_exact_buffer(const Options& with, const Work& call, std::size_t bytes) {
    faults->largest_buffer_bytes = bytes - 1;
    expect_refused(with, call, bytes, bytes - 1);
    faults->largest_buffer_bytes = bytes;
    {
      Triangulator triangulator(with);
      call(triangulator);
    }
    faults->largest_buffer_bytes = 0;
  }

  const std::shared_ptr<Faults> faults = std::make_shared<Faults>();
  const Injection injection{faults};
};

constexpr std::size_t fixed = 65536;

/// 124 bytes a point, or 97 where the result goes straight to host memory (docs/performance.md). The locked triangles
/// are one buffer.
TEST_P(ExactLimits, Insertion) {
  const Known known(uniform_points(20000));
  const DevicePoints points = upload(known.xy);
  const Options with = options(Strategy::locks);
  const Work of_host = [&](Triangulator& t) { EXPECT_EQ(t.triangulate(Reals(known.xy)).hash(), known.mesh.hash()); };
  const Work of_device = [&](Triangulator& t) {
    EXPECT_EQ(t.triangulate(points).download().hash(), known.mesh.hash());
  };
  const std::size_t waiting = Triangulator(with).memory_needed(known.size());
  expect_exact(with, of_host, fixed + (on_host_itself() ? 97 : 124) * known.size(), waiting);
  expect_exact(with, of_device, fixed + 124 * known.size(), waiting);
  for (const Work& call : {of_host, of_device})
    expect_exact_buffer(with, call, 2 * known.size() * sizeof(cadt_locked_triangle));
}

/// 83 bytes a point, or 71 where the points can be read once more. The stars are one buffer.
TEST_P(ExactLimits, Stars) {
  const Known known(uniform_points(40000));
  const DevicePoints points = upload(known.xy);
  const Options with = options(Strategy::stars);
  const Work of_host = [&](Triangulator& t) { EXPECT_EQ(t.triangulate(Reals(known.xy)).hash(), known.mesh.hash()); };
  const Work of_device = [&](Triangulator& t) {
    EXPECT_EQ(t.triangulate(points).download().hash(), known.mesh.hash());
  };
  const std::size_t waiting = Triangulator(with).memory_needed(known.size());
  expect_exact(with, of_host, 2 * fixed + 83 * known.size(), waiting);
  expect_exact(with, of_device, 2 * fixed + 71 * known.size(), waiting);
  for (const Work& call : {of_host, of_device}) expect_exact_buffer(with, call, fixed + 26 * known.size());
}

/// The call that reserve() is for has points and mesh on the device.
TEST_P(ExactLimits, Reserve) {
  constexpr std::size_t n = 20000;
  for (const auto& [strategy, bytes] :
       {std::pair{Strategy::locks, fixed + 124 * n}, std::pair{Strategy::stars, 2 * fixed + 71 * n}}) {
    Options with = options(strategy);
    const Work call = [](Triangulator& t) { t.reserve(n); };
    with.max_memory = bytes - 1;
    expect_refused(with, call, bytes, bytes - 1);
    with.max_memory = bytes;
    Triangulator triangulator(with);
    faults->clear();
    call(triangulator);
    EXPECT_LE(faults->most_bytes(), bytes);
  }
}

/// One more is a LimitError in every call; so many are not, but there is no memory for them here.
TEST_P(ExactLimits, MostPoints) {
  // Pages that nobody ever touches: each refusal comes before any work.
  const std::size_t bytes = (max_points() + 1) * sizeof(float);
  void* pages = mmap(nullptr, bytes, PROT_READ, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  ASSERT_NE(pages, MAP_FAILED);
  Options with = options(Strategy::locks);
  with.max_memory = 1;
  Triangulator triangulator(with);
  const auto floats = [&](std::size_t n) {
    const std::span<const float> all(static_cast<const float*>(pages), n);
    return PointsView(all, all);
  };
  const auto on_device = [&](std::size_t n) { return DevicePoints{.x = pages, .y = pages, .size = n}; };
  const auto offsets = [](std::size_t n) { return std::vector<std::size_t>{0, 10, n}; };
  const std::vector<std::function<void(std::size_t)>> calls = {
      [&](std::size_t n) { (void)triangulator.triangulate(floats(n)); },
      [&](std::size_t n) { (void)triangulator.triangulate(on_device(n)); },
      [&](std::size_t n) { (void)triangulator.triangulate_batch(floats(n), offsets(n)); },
      [&](std::size_t n) { (void)triangulator.triangulate_batch(on_device(n), offsets(n)); },
      [&](std::size_t n) { triangulator.reserve(n); },
      [&](std::size_t n) { (void)triangulate(floats(n), with); },
      [&](std::size_t n) { (void)triangulate_batch(floats(n), offsets(n), with); }};
  for (std::size_t k = 0; k < calls.size(); ++k) {
    SCOPED_TRACE("call " + std::to_string(k));
    const auto error = thrown<LimitError>([&] { calls[k](max_points() + 1); });
    ASSERT_NE(error, nullptr);
    EXPECT_EQ(error->count(), max_points() + 1);
    EXPECT_EQ(error->limit(), max_points());
    (void)thrown<OutOfMemory>([&] { calls[k](max_points()); });
  }
  EXPECT_EQ(faults->count(Step::launch), 0U);
  munmap(pages, bytes);
}

/// A batch, with the number of points and of sets of each of its groups.
class ExactGroups : public ExactLimits {
 protected:
  struct Group {
    std::uint32_t points, sets;
    friend bool operator==(const Group&, const Group&) = default;
    friend std::ostream& operator<<(std::ostream& out, const Group& g) {
      return out << g.points << " points of " << g.sets << " sets";
    }
  };
  void SetUp() override {
    ExactLimits::SetUp();
    faults->change_launch = [this](KernelId kernel, std::vector<Arg>& args) {
      if (kernel != KernelId::cadt_batch_gather) return;
      Group group{};
      std::memcpy(&group.points, args[6].value(), sizeof group.points);
      std::memcpy(&group.sets, args[3].value(), sizeof group.sets);
      groups.push_back(group);
    };
  }

  static std::vector<std::size_t> offsets_of(const std::vector<std::size_t>& sizes) {
    std::vector<std::size_t> offsets = {0};
    for (const std::size_t size : sizes) offsets.push_back(offsets.back() + size);
    return offsets;
  }

  void expect_meshes(const TriangulationBatch& batch, const Points& xy, const std::vector<std::size_t>& offsets) {
    ASSERT_EQ(batch.size() + 1, offsets.size());
    for (const std::size_t s : {std::size_t{0}, batch.size() / 2, batch.size() - 1}) {
      const Reals set = Reals(xy).subspan(2 * offsets[s], 2 * (offsets[s + 1] - offsets[s]));
      EXPECT_EQ(batch.triangulation(s).hash(), on_host(set).hash()) << s;
    }
  }

  std::vector<Group> groups;
};

/// Fewest points of a group: where memory is short, groups shrink down to this.
constexpr std::uint32_t fewest = 65536;

/// The locked triangles of a group are one buffer, up to the device's largest.
TEST_P(ExactGroups, LargestBuffer) {
  faults->largest_buffer_bytes = fewest * 2 * sizeof(cadt_locked_triangle);
  for (const std::size_t more : {0U, 1U}) {
    std::vector<std::size_t> sizes(150, 1024);
    sizes[63] += more;  // with it the first 64 sets are one point too many
    const std::vector<std::size_t> offsets = offsets_of(sizes);
    const Points xy = uniform_points(offsets.back());
    Triangulator triangulator(options(Strategy::automatic));
    groups.clear();
    expect_meshes(triangulator.triangulate_batch(Reals(xy), offsets), xy, offsets);
    const std::vector<Group> expected = more == 0
                                            ? std::vector<Group>{{fewest, 64}, {fewest, 64}, {22 * 1024, 22}}
                                            : std::vector<Group>{{63 * 1024, 63}, {63 * 1024 + 1, 63}, {24 * 1024, 24}};
    EXPECT_EQ(groups, expected);
  }
  faults->largest_buffer_bytes -= 1;
  const std::vector<std::size_t> offsets = offsets_of(std::vector<std::size_t>(64, 1024));
  const Points xy = uniform_points(fewest);
  Triangulator triangulator(options(Strategy::automatic));
  (void)thrown<OutOfMemory>([&] { (void)triangulator.triangulate_batch(Reals(xy), offsets); });
}

/// The result is among what is counted, unless it goes straight to memory of the host's.
TEST_P(ExactGroups, Memory) {
  constexpr std::size_t sets = 150, size = 1024, n = sets * size;
  const std::vector<std::size_t> offsets = offsets_of(std::vector<std::size_t>(sets, size));
  const Points xy = uniform_points(n);
  const DevicePoints points = upload(xy);
  const Options with = options(Strategy::automatic);
  const auto batch_bytes = [](std::size_t of) { return fixed + 176 * of + 1300 * sets; };
  const std::size_t arrays = 2 * 3 * sizeof(std::uint32_t) * sets * (2 * size - 5);
  struct Form {
    std::size_t result;
    Work call;
  };
  const Form host_points{on_host_itself() ? 0 : arrays, [&](Triangulator& t) {
                           const TriangulationBatch meshes = t.triangulate_batch(Reals(xy), offsets);
                           t.release_memory();  // the meshes compared with need some
                           expect_meshes(meshes, xy, offsets);
                         }};
  const Form device_points{arrays + offsets.size() * sizeof(std::uint32_t), [&](Triangulator& t) {
                             const TriangulationBatch meshes = t.triangulate_batch(points, offsets).download();
                             t.release_memory();
                             expect_meshes(meshes, xy, offsets);
                           }};
  for (const Form& form : {host_points, device_points}) {
    expect_exact(with, form.call, form.result + batch_bytes(fewest), form.result + batch_bytes(fewest));
    // a group has twice as many points as soon as that fits
    Options bounded = with;
    for (const bool fits : {false, true}) {
      bounded.max_memory = form.result + batch_bytes(2 * fewest) - (fits ? 0 : 1);
      Triangulator triangulator(bounded);
      groups.clear();
      faults->clear();
      form.call(triangulator);
      EXPECT_LE(faults->most_bytes(), bounded.max_memory);
      EXPECT_EQ(groups, (fits ? std::vector<Group>{{2 * fewest, 128}, {22 * 1024, 22}}
                              : std::vector<Group>{{fewest, 64}, {fewest, 64}, {22 * 1024, 22}}));
    }
  }
}

/// A set with so many points is batched with others, a set with one more is not; a group has 2^20 sets at most.
TEST_P(ExactGroups, Sets) {
  Triangulator triangulator(options(Strategy::automatic));
  const std::uint32_t most = triangulator.device().gpu ? 32768 : 8192;
  const std::vector<std::size_t> sizes = {100, most, 200, most + 1, 300, 400};
  const std::vector<std::size_t> offsets = offsets_of(sizes);
  const Points xy = uniform_points(offsets.back());
  const TriangulationBatch batch = triangulator.triangulate_batch(Reals(xy), offsets);
  expect_meshes(batch, xy, offsets);
  EXPECT_EQ(batch.statistics().batched_sets, 5U);
  EXPECT_EQ(groups, (std::vector<Group>{{300 + most, 3}, {700, 2}}));

  constexpr std::uint32_t most_sets = 1U << 20;
  std::vector<std::size_t> many(most_sets + 3);
  many.front() = many[most_sets - 1] = many[most_sets] = many.back() = 10;
  groups.clear();
  const Points few = uniform_points(40);
  const auto many_offsets = offsets_of(many);
  expect_meshes(triangulator.triangulate_batch(Reals(few), many_offsets), few, many_offsets);
  EXPECT_EQ(groups, (std::vector<Group>{{20, most_sets}, {20, 3}}));
}

CADT_ON_MAIN_BACKENDS(ExactLimits);
CADT_ON_MAIN_BACKENDS(ExactGroups);

}  // namespace
}  // namespace cadt::test
