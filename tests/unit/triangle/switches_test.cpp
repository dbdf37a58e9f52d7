// SPDX-License-Identifier: Apache-2.0
// Triangle's switches: what each sets, and how others are refused.
#include <cadt/triangle.hpp>

#include <gtest/gtest.h>
#include <set>
#include <string>
#include <vector>

namespace cadt {
namespace {

/// The letters of the members that are true.
std::string letters(const TriangleSwitches& s) {
  std::string text;
  for (const auto& [set, letter] : {std::pair{s.segments, 'p'},
                                    {s.region_attributes, 'A'},
                                    {s.ignore_holes, 'O'},
                                    {s.neighbors, 'n'},
                                    {s.edges, 'e'},
                                    {s.voronoi, 'v'},
                                    {s.hull_segments, 'c'},
                                    {s.off, 'g'},
                                    {s.jettison, 'j'},
                                    {s.zero_based, 'z'},
                                    {s.no_markers, 'B'},
                                    {s.no_poly, 'P'},
                                    {s.no_nodes, 'N'},
                                    {s.no_elements, 'E'},
                                    {s.no_iteration, 'I'},
                                    {s.quiet, 'Q'},
                                    {s.verbose, 'V'},
                                    {s.help, 'h'}}) {
    if (set) text += letter;
  }
  return text;
}

TEST(Switches, EachSetsItsMemberAlone) {
  for (const char letter : std::string("pnevcgjzBPNEIQVh")) {
    const TriangleSwitches found = parse_triangle_switches(std::string(1, letter));
    EXPECT_EQ(letters(found), std::string(1, letter));
    EXPECT_EQ(found.without_effect, "");
  }
}

struct Row {
  const char *text, *set, *without_effect;
};

TEST(Switches, WordsAreReadAsTriangleReadsThem) {
  for (const Row& row : std::vector<Row>{
           {"", "", ""},
           {"-", "", ""},
           {"-nev", "nev", ""},
           {"nev", "nev", ""},
           {"-n -e-v", "nev", ""},
           {"VVVV", "V", ""},
           {"zQz", "zQ", ""},
           {"-iFls", "", "iFls"},
           {"-iniei", "ne", "i"},
           {"-pAO", "pAO", ""},
           {"AOnp", "pAOn", ""},
           {"-pil", "p", "il"},
       }) {
    const TriangleSwitches found = parse_triangle_switches(row.text);
    EXPECT_EQ(letters(found), row.set) << row.text;
    EXPECT_EQ(found.without_effect, row.without_effect) << row.text;
  }
}

TEST(Switches, WhatHasNoEffectSaysWhy) {
  for (int c = 0; c < 256; ++c) {
    const char letter = static_cast<char>(c);
    const bool harmless = letter != '\0' && std::string("iFls").find(letter) != std::string::npos;
    EXPECT_EQ(why_without_effect(letter).empty(), !harmless) << c;
  }
}

struct Refusal {
  const char *text, *switches;
  std::vector<std::string> says;
};

TEST(Switches, OthersAreRefusedAllAtOnceAndWithTheReason) {
  for (const Refusal& row : std::vector<Refusal>{
           {"ps", "s", {"-s splits segments"}},
           {"sp", "s", {"-s splits segments"}},
           {"r", "r", {"-r refines a mesh"}},
           {"q", "q", {"-q adds points"}},
           {"a", "a", {"-a adds points"}},
           {"u", "u", {"-u adds points"}},
           {"D", "D", {"-D adds points"}},
           {"A", "A", {"-A is about regions between segments: add p"}},
           {"Y", "Y", {"-Y limits points"}},
           {"S", "S", {"-S limits points"}},
           {"O", "O", {"-O is about the holes that p reads: add p"}},
           {"X", "X", {"-X asks for inexact arithmetic"}},
           {"o2", "o", {"-o asks for triangles of six nodes"}},
           {"C", "C", {"-C checks", "cadt verify"}},
           {"T", "T", {"-T is no switch of Triangle"}},
           {"-n\x01", "\x01", {"-\\x01 is no switch of Triangle"}},
           {"n\xc3\xa4", "\xc3\xa4", {"-\\xc3 is no", "-\\xa4 is no"}},
           {"-pq31.5a.1n", "qa", {"-q adds", "-a adds"}},
           {"-YY", "Y", {"-Y limits"}},
           {"-q20q30e", "q", {"-q adds"}},
           {"3n", "3", {"-3 is no switch"}},
           {"n2", "2", {"-2 is no switch"}},
       }) {
    try {
      static_cast<void>(parse_triangle_switches(row.text));
      ADD_FAILURE() << row.text << " was taken";
    } catch (const SwitchError& e) {
      EXPECT_EQ(e.switches(), row.switches) << row.text;
      const std::string what = e.what();
      for (const std::string& text : row.says) EXPECT_NE(what.find(text), std::string::npos) << what;
    }
  }
}

TEST(Switches, EveryCharacterIsTakenOrRefused) {
  const std::string taken = "pnevcgjzBPNEIQVhiFls- ";
  for (int c = 1; c < 256; ++c) {
    const std::string text(1, static_cast<char>(c));
    if (taken.find(text) != std::string::npos) {
      EXPECT_NO_THROW(static_cast<void>(parse_triangle_switches(text))) << c;
    } else {
      EXPECT_THROW(static_cast<void>(parse_triangle_switches(text)), SwitchError) << c;
    }
  }
}

}  // namespace
}  // namespace cadt
