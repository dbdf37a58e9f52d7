// SPDX-License-Identifier: Apache-2.0
// Geometries of GeoJSON (RFC 7946), handed on as they are read.
#include "io/segments/readers.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

namespace cadt::io::detail {
namespace {

/// Reads a text and tells how far, so that messages can name a line.
class TrackedText {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;
  TrackedText(const char* at, const char** reached) : at_(at), reached_(reached) {}
  reference operator*() const { return *at_; }
  TrackedText& operator++() {
    *reached_ = ++at_;
    return *this;
  }
  TrackedText operator++(int) {
    TrackedText before = *this;
    ++*this;
    return before;
  }
  friend bool operator==(const TrackedText& a, const TrackedText& b) { return a.at_ == b.at_; }
  friend bool operator!=(const TrackedText& a, const TrackedText& b) { return a.at_ != b.at_; }

 private:
  const char* at_;
  const char** reached_;
};

/// The member "coordinates", whatever the type, which may follow it, makes of it.
struct Coordinates {
  std::vector<double> xy, z;
  std::size_t position_depth = 0;  ///< arrays around each number; 0 without any
  /// An array but a position that ended, itself one of so many arrays around what is in it, behind so many positions.
  struct End {
    std::size_t depth, positions;
    const char* at;  ///< the text behind it
  };
  std::vector<End> ends;
  bool given = false;
  [[nodiscard]] std::size_t positions() const noexcept { return xy.size() / 2; }
  [[nodiscard]] GeoJsonSink::Positions range(std::size_t from, std::size_t to) const {
    const bool heights = z.size() == positions();  // else some positions have none
    return {std::span(xy).subspan(2 * from, 2 * (to - from)),
            heights ? std::span(z).subspan(from, to - from) : std::span<const double>(), !z.empty()};
  }
};

struct Object {
  std::string type, key;
  Coordinates coordinates;
  std::size_t feature = 0;
};

struct GeometryType {
  const char* name;
  std::size_t depth;  ///< arrays around a number
};
constexpr GeometryType geometry_types[] = {{"Point", 1},           {"MultiPoint", 2}, {"LineString", 2},
                                           {"MultiLineString", 3}, {"Polygon", 3},    {"MultiPolygon", 4}};
constexpr const char* other_types[] = {"Feature", "FeatureCollection", "GeometryCollection"};

/// Called by nlohmann's parser.
class Scanner {
 public:
  Scanner(const std::string& name, std::string_view text, GeoJsonSink& sink) : name_(name), text_(text), sink_(sink) {
    reached_ = text_.data();
  }

  void scan() {
    const char* const end = text_.data() + text_.size();
    nlohmann::json::sax_parse(TrackedText(text_.data(), &reached_), TrackedText(end, &reached_), this);
  }
  [[nodiscard]] GeoJsonSummary summary() const { return {std::max<std::size_t>(features_, 1), crs_}; }

  bool null() { return value(nullptr); }
  bool boolean(bool) { return value("a truth value"); }
  // With a minus sign, so 0 is -0.
  bool number_integer(std::int64_t v) { return number(v == 0 ? -0.0 : static_cast<double>(v)); }
  bool number_unsigned(std::uint64_t v) { return number(static_cast<double>(v)); }
  bool number_float(double v, const std::string&) { return number(v); }
  bool binary(std::vector<std::uint8_t>&) { return true; }
  bool string(std::string& text) {
    if (skipped_ == 0 && depth_ == 0 && !objects_.empty() && objects_.back().key == "type") {
      objects_.back().type = text;
      return true;
    }
    // "crs": {"type": "name", "properties": {"name": "..."}}
    const bool names_crs = skipped_ == 2 && objects_.size() == 1 && objects_.back().key == "crs";
    if (names_crs && skipped_key_ == "name") crs_ = text;
    return value("text");
  }
  bool key(std::string& text) {
    (skipped_ == 0 ? objects_.back().key : skipped_key_) = text;
    return true;
  }
  bool start_object(std::size_t) {
    if (skipped_ != 0 || skips()) return ++skipped_, true;
    if (depth_ != 0) fail("an object is where numbers should be");
    Object object;
    if (!objects_.empty()) {
      object.feature = objects_.back().feature;
      if (objects_.back().key == "features") object.feature = features_++;
    }
    objects_.push_back(std::move(object));
    return true;
  }
  bool end_object() {
    if (skipped_ != 0) return --skipped_, true;
    hand_on(objects_.back());
    objects_.pop_back();
    return true;
  }
  bool start_array(std::size_t) {
    if (skipped_ != 0) return ++skipped_, true;
    if (objects_.empty() && depth_ == 0) {  // a bare array of rings
      objects_.emplace_back();
      objects_.back().type = "Polygon";
      objects_.back().key = "coordinates";
      bare_ = true;
    }
    if (depth_ == 0 && objects_.back().key != "coordinates") {
      if (skips()) ++skipped_;
      return true;  // features, geometries
    }
    if (depth_ == 0 && coordinates().given) fail("there are coordinates a second time");
    if (!position_.empty()) fail("an array is where a number should be");
    ++depth_;
    coordinates().given = true;
    return true;
  }
  bool end_array() {
    if (skipped_ != 0) return --skipped_, true;
    if (depth_ == 0) return true;
    Coordinates& all = coordinates();
    if (position_.empty()) {
      all.ends.push_back({depth_, all.positions(), reached_});
    } else {
      end_position(all);
    }
    if (--depth_ == 0 && bare_) {
      hand_on(objects_.back());
      objects_.pop_back();
    }
    return true;
  }
  bool parse_error(std::size_t, const std::string&, const nlohmann::json::exception& error) {
    const std::string what = error.what();  // "[json.exception.parse_error.101] parse error at line 1, column 2: ..."
    const std::size_t colon = what.find(": ");
    constexpr int number_overflow = 406;
    if (error.id == number_overflow) fail("a number is beyond the largest double");
    fail("is no JSON: " + (colon == std::string::npos ? what : what.substr(colon + 2)));
  }

 private:
  [[noreturn]] void fail(const std::string& message) const {
    const auto lines = std::count(text_.data(), reached_ == text_.data() ? reached_ : reached_ - 1, '\n');
    throw FileError(name_, static_cast<std::size_t>(lines) + 1, message);
  }
  [[nodiscard]] Coordinates& coordinates() { return objects_.back().coordinates; }

  /// Whether an array or an object that starts here is none of geometry.
  [[nodiscard]] bool skips() const {
    if (objects_.empty() || depth_ != 0) return false;
    const std::string& key = objects_.back().key;
    return key != "features" && key != "geometries" && key != "geometry" && key != "coordinates";
  }

  /// Something that is no number, array or object; nullptr: null.
  bool value(const char* what) {
    if (skipped_ != 0) return true;
    if (objects_.empty()) fail("is no GeoJSON: it is neither an object nor an array of rings");
    if (depth_ != 0) fail((what == nullptr ? std::string("null") : std::string(what)) + " is where numbers should be");
    if (what == nullptr && objects_.back().key == "features") fail("a feature is null");
    if (!skips() && what != nullptr) fail("'" + objects_.back().key + "' is " + what);
    return true;
  }

  bool number(double v) {
    if (skipped_ != 0 || depth_ == 0) return value("a number");
    if (!coordinates().ends.empty() && position_.empty() && coordinates().position_depth > depth_) {
      fail("a number is where an array should be");
    }
    position_.push_back(v);
    return true;
  }

  void end_position(Coordinates& all) {
    if (position_.size() < 2) fail("a position needs two numbers");
    if (all.position_depth == 0) all.position_depth = depth_;
    if (all.position_depth != depth_) fail("positions are in different numbers of arrays");
    all.xy.insert(all.xy.end(), {position_[0], position_[1]});
    if (position_.size() > 2) all.z.push_back(position_[2]);
    position_.clear();
  }

  void hand_on(const Object& object) {
    const auto of_type = [&](const GeometryType& t) { return object.type == t.name; };
    const auto type = std::find_if(std::begin(geometry_types), std::end(geometry_types), of_type);
    if (type == std::end(geometry_types)) {
      const bool known = std::any_of(std::begin(other_types), std::end(other_types),
                                     [&](const char* name) { return object.type == name; });
      if (object.type.empty()) fail("is no GeoJSON: an object has no 'type'");
      if (!known) fail("is no GeoJSON: " + detail::quoted(object.type) + " is no type of it");
      return;
    }
    const Coordinates& all = object.coordinates;
    if (!all.given) fail("the " + object.type + " has no coordinates");
    require_depth(object.type, all, type->depth);
    const bool polygons = object.type.ends_with("Polygon");
    if (all.positions() == 0 && !polygons) return;
    if (type->depth == 1 || object.type == "MultiPoint") return sink_.points(all.range(0, all.positions()));
    const std::size_t part_depth = type->depth - 1;  // of lines and rings
    std::size_t from = 0;
    bool outer = true;
    for (const Coordinates::End& end : all.ends) {
      if (end.depth == part_depth) {
        const std::size_t to = end.positions;
        if (polygons)
          sink_.ring(without_repetition(all, from, to), std::exchange(outer, false), object.feature);
        else if (to != from)
          sink_.line(all.range(from, to));
        from = to;
      } else if (polygons && end.depth + 1 == part_depth) {
        if (std::exchange(outer, true)) sink_.ring({}, true, object.feature);  // a polygon without rings
      }
    }
  }

  /// Positions, and arrays where positions should be, are in so many arrays, themselves included. \throws FileError
  void require_depth(const std::string& type, const Coordinates& all, std::size_t depth) {
    const bool any = all.positions() != 0;
    if (any && all.position_depth != depth && bare_) {
      fail("a bare array is taken for the rings of one polygon, [[[x, y], ...], ...], and here positions are in " +
           std::to_string(all.position_depth) + (all.position_depth == 1 ? " array" : " arrays") +
           ": give GeoJSON, as {\"type\": \"MultiPoint\", \"coordinates\": ...}, or a table of points");
    }
    if (any && all.position_depth != depth) {
      fail("the coordinates of the " + type + " are in " + std::to_string(all.position_depth) + " arrays instead of " +
           std::to_string(depth));
    }
    for (const Coordinates::End& end : all.ends) {
      if (end.depth < std::max<std::size_t>(depth, 2)) continue;  // a Point may have none: "coordinates": []
      reached_ = end.at;
      fail("a position needs two numbers");
    }
  }

  static GeoJsonSink::Positions without_repetition(const Coordinates& all, std::size_t from, std::size_t to) {
    const auto& xy = all.xy;
    const bool repeated = to - from > 1 && xy[2 * from] == xy[2 * to - 2] && xy[2 * from + 1] == xy[2 * to - 1];
    return all.range(from, repeated ? to - 1 : to);
  }

  const std::string& name_;
  std::string_view text_;
  GeoJsonSink& sink_;
  const char* reached_ = nullptr;
  std::vector<Object> objects_;   ///< those around, but skipped ones
  std::size_t skipped_ = 0;       ///< arrays and objects around of which nothing is read
  std::size_t depth_ = 0;         ///< arrays around within coordinates
  std::vector<double> position_;  ///< the numbers of the array that is being read
  std::size_t features_ = 0;
  std::string skipped_key_, crs_;
  bool bare_ = false;
};

}  // namespace

GeoJsonSummary scan_geojson(const std::string& name, std::string_view text, GeoJsonSink& sink) {
  Scanner scanner(name, text, sink);
  scanner.scan();
  return scanner.summary();
}

}  // namespace cadt::io::detail
