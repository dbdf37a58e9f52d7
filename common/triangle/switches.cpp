// SPDX-License-Identifier: Apache-2.0
// Triangle's switches: which are taken, which change nothing, and why the others are refused.
#include <cadt/triangle.hpp>

#include <algorithm>
#include <array>

namespace cadt {
namespace {

struct Taken {
  char letter;
  bool TriangleSwitches::*member;
};
constexpr Taken taken[] = {
    {'p', &TriangleSwitches::segments},      {'A', &TriangleSwitches::region_attributes},
    {'O', &TriangleSwitches::ignore_holes},  {'n', &TriangleSwitches::neighbors},
    {'e', &TriangleSwitches::edges},         {'v', &TriangleSwitches::voronoi},
    {'c', &TriangleSwitches::hull_segments}, {'g', &TriangleSwitches::off},
    {'j', &TriangleSwitches::jettison},      {'z', &TriangleSwitches::zero_based},
    {'B', &TriangleSwitches::no_markers},    {'P', &TriangleSwitches::no_poly},
    {'N', &TriangleSwitches::no_nodes},      {'E', &TriangleSwitches::no_elements},
    {'I', &TriangleSwitches::no_iteration},  {'Q', &TriangleSwitches::quiet},
    {'V', &TriangleSwitches::verbose},       {'h', &TriangleSwitches::help},
};

struct Reason {
  char letter;
  std::string_view text;
};
constexpr std::string_view one_algorithm = "chooses an algorithm of Triangle's; the mesh of cadt depends on none";
constexpr Reason harmless[] = {
    {'i', one_algorithm},
    {'F', one_algorithm},
    {'l', one_algorithm},
    {'s', "says how segments are split, and a set of points has none"},
};

constexpr std::string_view refinement = "adds points until angles or areas are as asked; cadt adds no points";
constexpr Reason refused[] = {
    {'r', "refines a mesh; cadt starts from points"},
    {'q', refinement},
    {'a', refinement},
    {'u', refinement},
    {'D', refinement},
    {'Y', "limits points that refinement adds; cadt adds none"},
    {'S', "limits points that refinement adds; cadt adds none"},
    {'X', "asks for inexact arithmetic; cadt is always exact: leave it out"},
    {'o', "asks for triangles of six nodes; those of cadt have three"},
    {'C',
     "checks the mesh as it is written; use: cadt verify, or for a .poly file cadt triangulate --domain seeds "
     "--verify"},
};

/// Why letters are refused together with p, or without it.
constexpr Reason refused_with_p[] = {
    {'s', "splits segments at new points; cadt adds no points: leave it out, and segments are chains of edges"},
};
constexpr Reason refused_without_p[] = {
    {'A', "is about regions between segments: add p"},
    {'O', "is about the holes that p reads: add p"},
};

template <std::size_t n>
std::string_view reason_in(const Reason (&list)[n], char letter) noexcept {
  const auto found =
      std::find_if(std::begin(list), std::end(list), [&](const Reason& r) { return r.letter == letter; });
  return found == std::end(list) ? std::string_view() : found->text;
}

std::string printable(char letter) {
  constexpr char hex[] = "0123456789abcdef";
  const auto byte = static_cast<unsigned char>(letter);
  if (byte > 0x20 && byte < 0x7f) return {letter};
  return {'\\', 'x', hex[byte >> 4], hex[byte & 15]};
}

constexpr bool is_of_number(char c) noexcept { return (c >= '0' && c <= '9') || c == '.'; }

}  // namespace

std::string_view why_without_effect(char letter) noexcept { return reason_in(harmless, letter); }

TriangleSwitches parse_triangle_switches(std::string_view text) {
  TriangleSwitches switches;
  std::string bad, message;
  const bool with_p = text.find('p') != std::string_view::npos;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char letter = text[i];
    if (letter == '-' || letter == ' ') continue;
    const std::string_view conflict = with_p ? reason_in(refused_with_p, letter) : reason_in(refused_without_p, letter);
    const auto known =
        std::find_if(std::begin(taken), std::end(taken), [&](const Taken& t) { return t.letter == letter; });
    if (conflict.empty() && known != std::end(taken)) {
      switches.*known->member = true;
    } else if (conflict.empty() && !why_without_effect(letter).empty()) {
      if (switches.without_effect.find(letter) == std::string::npos) switches.without_effect += letter;
    } else if (bad.find(letter) == std::string::npos) {
      bad += letter;
      const std::string_view why = conflict.empty() ? reason_in(refused, letter) : conflict;
      message += (message.empty() ? "-" : "; -") + printable(letter) + " ";
      message += why.empty() ? "is no switch of Triangle" : why;
    }
    // Those that take a number are all refused; it belongs to the letter before it.
    if (!bad.empty() && letter == bad.back()) {
      while (i + 1 < text.size() && is_of_number(text[i + 1])) ++i;
    }
  }
  if (!bad.empty()) throw SwitchError("cannot do what these switches ask for: " + message, bad);
  return switches;
}

}  // namespace cadt
