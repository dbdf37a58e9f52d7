// SPDX-License-Identifier: Apache-2.0
// Triangle's call in C.
#include <cadt/triangulateio.h>
#include <cadt/triangle.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <new>
#include <string>
#include <system_error>

namespace cadt {
namespace {

static_assert(sizeof(int) == sizeof(std::int32_t));
using Struct = cadt_triangulateio;

/// The thread's last message, in an array of its own: there may be nothing left to allocate.
thread_local char message[2048] = "";

int finished(int status, const char* text) noexcept {
  std::size_t i = 0;
  for (; text[i] != '\0' && i + 1 < sizeof message; ++i) message[i] = text[i];
  message[i] = '\0';
  return status;
}

/// An array for a member of the caller's struct: the caller's memory if there is some, else its own until `store`.
template <class T>
class Array {
 public:
  Array(T*& member, bool wanted, std::size_t count) : member_(member), wanted_(wanted) {
    if (!wanted || member != nullptr) return;
    owned_.reset(static_cast<T*>(std::malloc(std::max<std::size_t>(count * sizeof(T), 1))));
    if (!owned_) throw std::bad_alloc();
  }
  /// Numbers that are not negative are shifted.
  void fill(std::span<const std::int32_t> values, std::int32_t shift) {
    if (!wanted_) return;
    std::transform(values.begin(), values.end(), data(), [&](std::int32_t v) { return v < 0 ? v : v + shift; });
  }
  void fill(std::span<const T> values) {
    // The caller's memory may be that of the input.
    if (wanted_ && values.data() != data()) std::copy(values.begin(), values.end(), data());
  }
  [[nodiscard]] T* data() noexcept { return owned_ ? owned_.get() : member_; }
  void store() noexcept {
    if (owned_) member_ = owned_.release();
  }

 private:
  struct Free {
    void operator()(T* p) const noexcept { std::free(p); }
  };
  T*& member_;
  bool wanted_;
  std::unique_ptr<T, Free> owned_;
};

TriangleInput checked_input(const Struct& in) {
  const auto require = [](bool holds, const char* text) {
    if (!holds) throw InputError(text, 0);
  };
  require(in.numberofpoints >= 0, "numberofpoints is negative");
  require(in.numberofpointattributes >= 0, "numberofpointattributes is negative");
  const auto points = static_cast<std::size_t>(in.numberofpoints);
  TriangleInput input;
  input.attributes_per_point = static_cast<std::size_t>(in.numberofpointattributes);
  const std::size_t attributes = points * input.attributes_per_point;
  require(points == 0 || in.pointlist != nullptr, "pointlist is NULL");
  require(attributes == 0 || in.pointattributelist != nullptr,
          "pointattributelist is NULL, and numberofpointattributes is not 0");
  if (points != 0) input.xy = {in.pointlist, 2 * points};
  if (attributes != 0) input.attributes = {in.pointattributelist, attributes};
  if (in.pointmarkerlist != nullptr) input.markers = {in.pointmarkerlist, points};
  return input;
}

/// Segments, holes and regions, in arrays of their own.
struct Constraints {
  std::vector<Segment> segments;
  std::span<const int> markers;
  std::vector<std::array<double, 2>> holes;
  std::vector<Region> regions;
  [[nodiscard]] TriangleSegments view() const { return {segments, markers, holes, regions}; }
};

void require_finite(const char* list, const char* of, std::ptrdiff_t i, const double* place) {
  if (std::isfinite(place[0]) && std::isfinite(place[1])) return;
  throw InputError(std::string(list) + ", " + of + " " + std::to_string(i) +
                       " counted from 0: its place is not finite: give x and y as finite numbers",
                   static_cast<std::size_t>(i));
}

Constraints checked_constraints(const Struct& in, const TriangleSwitches& use) {
  const int base = use.zero_based ? 0 : 1;
  const auto require = [](bool holds, const char* text) {
    if (!holds) throw InputError(text, 0);
  };
  require(in.numberofsegments >= 0, "numberofsegments is negative");
  require(in.numberofholes >= 0, "numberofholes is negative");
  require(in.numberofregions >= 0, "numberofregions is negative");
  require(in.numberofsegments == 0 || in.segmentlist != nullptr, "segmentlist is NULL");
  require(in.numberofholes == 0 || in.holelist != nullptr, "holelist is NULL");
  require(in.numberofregions == 0 || in.regionlist != nullptr, "regionlist is NULL");
  Constraints result;
  for (std::ptrdiff_t i = 0; i < in.numberofsegments; ++i) {
    Segment segment{in.segmentlist[2 * i], in.segmentlist[2 * i + 1]};
    for (std::int32_t& v : segment) {
      if (v < base || v - base >= in.numberofpoints) {
        throw InputError(
            "segmentlist, segment " + std::to_string(i) + " counted from 0: there is no point " + std::to_string(v),
            static_cast<std::size_t>(i));
      }
      v -= base;
    }
    result.segments.push_back(segment);
  }
  if (in.segmentmarkerlist != nullptr) {
    result.markers = {in.segmentmarkerlist, static_cast<std::size_t>(in.numberofsegments)};
  }
  for (std::ptrdiff_t i = 0; i < in.numberofholes; ++i) {
    if (!use.ignore_holes) require_finite("holelist", "hole", i, in.holelist + 2 * i);
    result.holes.push_back({in.holelist[2 * i], in.holelist[2 * i + 1]});
  }
  for (std::ptrdiff_t i = 0; i < in.numberofregions; ++i) {
    const double* region = in.regionlist + 4 * i;
    require_finite("regionlist", "region", i, region);
    result.regions.push_back({region[0], region[1], region[2]});
  }
  return result;
}

/// The counts fit: 2^29 points have less than 2^31 edges.
int count(std::size_t values, std::size_t each) { return static_cast<int>(values / each); }

void set_voronoi(const TriangleOutput& result, std::int32_t base, Struct& vorout) {
  Array<double> points(vorout.pointlist, true, result.centers.size());
  Array<double> attributes(vorout.pointattributelist, result.attributes_per_point != 0,
                           result.center_attributes.size());
  Array<int> edges(vorout.edgelist, true, result.edge_triangles.size());
  Array<double> rays(vorout.normlist, true, result.rays.size());
  points.fill(result.centers);
  attributes.fill(result.center_attributes);
  edges.fill(result.edge_triangles, base);
  rays.fill(result.rays);
  points.store(), attributes.store(), edges.store(), rays.store();
  vorout.numberofpoints = count(result.centers.size(), 2);
  vorout.numberofpointattributes = static_cast<int>(result.attributes_per_point);
  vorout.numberofedges = static_cast<int>(result.number_of_edges);
}

void set_outputs(const TriangleSwitches& use, const TriangleOutput& result, Struct& out, Struct* vorout) {
  const std::int32_t base = use.zero_based ? 0 : 1;
  const bool segments_wanted = (use.hull_segments || use.segments) && !use.no_poly;
  Array<double> points(out.pointlist, !use.no_nodes, result.xy.size());
  Array<double> attributes(out.pointattributelist, !use.no_nodes && result.attributes_per_point != 0,
                           result.attributes.size());
  Array<int> markers(out.pointmarkerlist, !use.no_nodes && !use.no_markers, result.markers.size());
  Array<int> triangles(out.trianglelist, !use.no_elements, result.triangles.size());
  const bool attributed = use.region_attributes && !use.no_elements;
  Array<double> triangle_attributes(out.triangleattributelist, attributed, result.triangle_attributes.size());
  Array<int> neighbors(out.neighborlist, use.neighbors, result.neighbors.size());
  Array<int> segments(out.segmentlist, segments_wanted, result.segments.size());
  Array<int> segment_markers(out.segmentmarkerlist, segments_wanted && !use.no_markers, result.segment_markers.size());
  Array<int> edges(out.edgelist, use.edges, result.edges.size());
  Array<int> edge_markers(out.edgemarkerlist, use.edges && !use.no_markers, result.edge_markers.size());
  if (use.voronoi) set_voronoi(result, base, *vorout);  // the last that can fail

  points.fill(result.xy), attributes.fill(result.attributes), markers.fill(result.markers);
  triangles.fill(result.triangles, base), neighbors.fill(result.neighbors, base);
  segments.fill(result.segments, base), segment_markers.fill(std::span<const int>(result.segment_markers));
  triangle_attributes.fill(result.triangle_attributes);
  edges.fill(result.edges, base), edge_markers.fill(std::span<const int>(result.edge_markers));
  points.store(), attributes.store(), markers.store(), triangles.store(), neighbors.store();
  segments.store(), segment_markers.store(), edges.store(), edge_markers.store();
  triangle_attributes.store();
  out.numberofpoints = count(result.xy.size(), 2);
  out.numberofpointattributes = static_cast<int>(result.attributes_per_point);
  out.numberoftriangles = count(result.triangles.size(), 3);
  out.numberofcorners = 3;
  out.numberoftriangleattributes = use.region_attributes ? 1 : 0;
  out.numberofsegments = count(result.segments.size(), 2);
  out.numberofedges = static_cast<int>(result.number_of_edges);
}

void run(const char* text, const Struct* in, Struct* out, Struct* vorout) {
  if (text == nullptr || in == nullptr || out == nullptr) throw InputError("switches, in or out is NULL", 0);
  const TriangleSwitches use = parse_triangle_switches(text);
  if (use.voronoi && vorout == nullptr) throw InputError("switch v needs vorout, which is NULL", 0);
  const TriangleInput input = checked_input(*in);
  Options options;
  options.statistics = StatisticsDetail::none;
  const Constraints constraints = use.segments ? checked_constraints(*in, use) : Constraints();
  Triangulation mesh;
  ConstrainedTriangulation constrained;
  try {
    if (use.segments) {
      constrained = triangulate_as_triangle(input, constraints.view(), use, options);
    } else {
      mesh = triangulate(input.xy, options);
    }
  } catch (const InputError& e) {
    throw InputError("pointlist, point " + std::to_string(e.index()) + " counted from 0: " + e.what(), e.index());
  }
  set_outputs(
      use,
      use.segments ? triangle_output(input, constraints.view(), constrained, use) : triangle_output(input, mesh, use),
      *out, vorout);
  if (!use.segments) return;
  // As in Triangle, these are the arrays of the input.
  out->numberofholes = in->numberofholes;
  out->holelist = in->holelist;
  out->numberofregions = in->numberofregions;
  out->regionlist = in->regionlist;
}

/// To be called in a catch block.
int status_of_exception() noexcept {
  constexpr const char* no_memory = "out of memory: use fewer points";
  try {
    throw;
  } catch (const SwitchError& e) {
    return finished(CADT_TRIANGLE_SWITCHES, e.what());
  } catch (const InputError& e) {
    return finished(CADT_TRIANGLE_INPUT, e.what());
  } catch (const CrossingError& e) {
    return finished(CADT_TRIANGLE_INPUT, e.what());
  } catch (const LimitError& e) {
    return finished(CADT_TRIANGLE_INPUT, e.what());
  } catch (const BackendUnavailable& e) {
    return finished(CADT_TRIANGLE_DEVICE, e.what());
  } catch (const KernelBuildError& e) {
    return finished(CADT_TRIANGLE_DEVICE, e.what());
  } catch (const DeviceError& e) {
    return finished(CADT_TRIANGLE_DEVICE, e.what());
  } catch (const OutOfMemory& e) {
    return finished(CADT_TRIANGLE_MEMORY, e.what());
  } catch (const std::bad_alloc&) {
    return finished(CADT_TRIANGLE_MEMORY, no_memory);
  } catch (const std::length_error&) {  // an array that no memory could hold
    return finished(CADT_TRIANGLE_MEMORY, no_memory);
  } catch (const std::system_error& e) {  // a thread that cannot be started
    return finished(CADT_TRIANGLE_MEMORY, e.what());
  } catch (const std::exception& e) {
    return finished(CADT_TRIANGLE_INTERNAL, e.what());
  } catch (...) {
    return finished(CADT_TRIANGLE_INTERNAL, "unknown exception");
  }
}

}  // namespace
}  // namespace cadt

extern "C" {

int cadt_triangle(const char* switches, const struct cadt_triangulateio* in, struct cadt_triangulateio* out,
                  struct cadt_triangulateio* vorout) {
  try {
    cadt::run(switches, in, out, vorout);
    return cadt::finished(CADT_TRIANGLE_DONE, "");
  } catch (...) {
    return cadt::status_of_exception();
  }
}

const char* cadt_triangle_message(void) { return cadt::message; }

void cadt_trifree(void* array) { std::free(array); }
}
