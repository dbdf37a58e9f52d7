// SPDX-License-Identifier: Apache-2.0
// Tables: separators, headers, comments, columns, and what is wrong with a line.
#include "tests/unit/io/io_test_support.hpp"

#include <clocale>
#include <locale>
#include <sstream>

namespace cadt::io::test {
namespace {

struct TableCase {
  const char* name;
  const char* content;
  Values xy, height;
};

class TableReads : public ::testing::TestWithParam<TableCase> {};

TEST_P(TableReads, PointsAndHeights) {
  const Folder folder;
  const PointSet points = read_points(folder.file("t.txt", GetParam().content));
  EXPECT_EQ(points.xy, GetParam().xy);
  EXPECT_EQ(points.height, GetParam().height);
  EXPECT_EQ(points.format, "txt");
}

INSTANTIATE_TEST_SUITE_P(
    Layouts, TableReads,
    ::testing::Values(TableCase{"blanks", "1 2\n3   4\n", {1, 2, 3, 4}, {}},
                      TableCase{"no_final_newline", "1 2\n3 4", {1, 2, 3, 4}, {}},
                      TableCase{"leading_blanks", "  1\t 2 \n  3 4\t\n", {1, 2, 3, 4}, {}},
                      TableCase{"tabs_and_trailing_blanks", "1\t2\t5\t      \n3\t4\t6\t   \n", {1, 2, 3, 4}, {5, 6}},
                      TableCase{"tabs_that_align", "1\t\t2\n10\t3\n", {1, 2, 10, 3}, {}},
                      TableCase{"tabs_between_numbers_with_blanks", "1 2\t5\n3 4\t6\n", {1, 2, 3, 4}, {5, 6}},
                      TableCase{"commas", "1,2\n3,4\n", {1, 2, 3, 4}, {}},
                      TableCase{"commas_and_blanks", "1, 2\n 3 ,4\n", {1, 2, 3, 4}, {}},
                      TableCase{"final_commas", "1,2,\n3,4,\n", {1, 2, 3, 4}, {}},
                      TableCase{"semicolons", "1;2;3\n4;5;6\n", {1, 2, 4, 5}, {3, 6}},
                      TableCase{"crlf", "1 2\r\n3 4\r\n", {1, 2, 3, 4}, {}},
                      TableCase{"byte_order_mark",
                                "\xef\xbb\xbf"
                                "1 2\n3 4\n",
                                {1, 2, 3, 4},
                                {}},
                      TableCase{"byte_order_mark_and_header", "\xef\xbb\xbfx,y\r\n1,2\r\n", {1, 2}, {}},
                      TableCase{"comments", "# a\n\n// b\n> segment\n1 2 # c\n3 4 // d\n   # e\n", {1, 2, 3, 4}, {}},
                      TableCase{"third_column", "1 2 3\n4 5 6\n", {1, 2, 4, 5}, {3, 6}},
                      TableCase{"four_columns", "1 2 3 a\n4 5 6 b\n", {1, 2, 4, 5}, {3, 6}},
                      TableCase{"third_column_is_text", "1 2 a\n4 5 7\n", {1, 2, 4, 5}, {}},
                      TableCase{"header", "a,b\n1,2\n", {1, 2}, {}},
                      TableCase{"header_with_height", "a,b,c\n1,2,3\n", {1, 2}, {3}},
                      TableCase{"header_xyz_reordered", "Z,Y,X\n1,2,3\n4,5,6\n", {3, 2, 6, 5}, {1, 4}},
                      TableCase{"header_x_y_only", "id,X,Y\n7,2,3\n", {2, 3}, {}},
                      TableCase{"header_lat_lon", "lat;lon\n50;8\n", {8, 50}, {}},
                      TableCase{"header_long_names", "Latitude\tLongitude\tElevation\n50\t8\t100\n", {8, 50}, {100}},
                      TableCase{"header_easting_northing", "name easting NORTHING\np 3 4\n", {3, 4}, {}},
                      TableCase{"header_with_a_number", "x,y,2019\n1,2,3\n", {1, 2}, {}},
                      TableCase{"header_with_text_of_tabs", "city name\tx\ty\nNew York\t1\t2\n", {1, 2}, {}},
                      TableCase{"empty_cells_elsewhere", "a\tx\ty\n\t1\t2\n", {1, 2}, {}},
                      TableCase{"quotes", "\"x\",\"y\",\"n\"\n\"1\",2,\"a, \"\"b\"\"\"\n3,4,\"c\"\n", {1, 2, 3, 4}, {}},
                      TableCase{"quoted_line_end", "n,x,y\n\"a\nb\",1,2\n\"c\",3,4\n", {1, 2, 3, 4}, {}},
                      TableCase{"number_forms", "+1 -.5\n1e3 2.5E-1\n1. 007\n", {1, -.5, 1000, .25, 1, 7}, {}},
                      TableCase{"tiny_numbers_round_to_zero", "1e-400 5e-324\n", {0, 5e-324}, {}}),
    [](const auto& test) { return std::string(test.param.name); });

TEST(Table, ChosenColumns) {
  const Folder folder;
  const std::string path = folder.file("t.csv", "id,x,y,lon,lat,depth\n1,2,3,4,5,6\n");
  const auto read = [&](const std::string& columns) { return read_points(path, {.format = {}, .columns = columns}); };
  EXPECT_EQ(read("").xy, (Values{2, 3}));
  EXPECT_EQ(read("5,4").xy, (Values{5, 4}));
  EXPECT_EQ(read("LON, Lat").xy, (Values{4, 5}));
  EXPECT_TRUE(read("lon,lat").height.empty());
  EXPECT_EQ(read("lon,lat,depth").height, Values{6});
  EXPECT_EQ(read("lon,2,1").xy, (Values{4, 2}));
  EXPECT_EQ(read("lon,2,1").height, Values{1});
  expect_read_error(path, 1, "no column named 'up'", {.format = {}, .columns = "lon,up"});
  expect_read_error(path, 1, "two or three", {.format = {}, .columns = "1"});
  expect_read_error(path, 1, "counted from 1", {.format = {}, .columns = "0,1"});
  expect_read_error(path, 2, "6 fields, column 9 is expected", {.format = {}, .columns = "1,9"});
}

TEST(Table, NamesThatDoNotTellTheCoordinates) {
  const Folder folder;
  const std::string path = folder.file("t.csv", "point_id,easting_m,northing_m,elev_m\n1,50,8,3\n");
  expect_read_error(path, 1, "of 4 columns with names none are x and y");
  EXPECT_EQ(read_points(path, {.format = {}, .columns = "easting_m,3"}).xy, (Values{50, 8}));
}

TEST(Table, ChosenColumnsOfATableWithoutHeader) {
  const Folder folder;
  const std::string path = folder.file("t.txt", "a 1 2 3\nb 4 5 6\n");
  EXPECT_EQ(read_points(path, {.format = {}, .columns = "4,2"}).xy, (Values{3, 1, 6, 4}));
  expect_read_error(path, 1, "column 1: 'a' is not a decimal number");
}

TEST(Table, ColumnsAreForTablesOnly) {
  const Folder folder;
  expect_read_error(folder.file("t.off", "OFF 1 0 0\n0 0 0\n"), 0, "tables only", {.format = {}, .columns = "1,2"});
}

TEST(Table, Projections) {
  const Folder folder;
  const std::string path = folder.file("t.xyz", "1 2 3\n");
  const auto read = [&](Projection p) { return read_points(path, {.format = {}, .columns = {}, .projection = p}); };
  EXPECT_EQ(read(Projection::xy).xy, (Values{1, 2}));
  EXPECT_EQ(read(Projection::xy).height, Values{3});
  EXPECT_EQ(read(Projection::yz).xy, (Values{2, 3}));
  EXPECT_EQ(read(Projection::yz).height, Values{1});
  EXPECT_EQ(read(Projection::zx).xy, (Values{3, 1}));
  EXPECT_EQ(read(Projection::zx).height, Values{2});
  expect_read_error(folder.file("plane.xy", "1 2\n"), 0, "three coordinates",
                    {.format = {}, .columns = {}, .projection = Projection::yz});
}

struct BadTable {
  const char* name;
  const char* content;
  std::size_t line;
  const char* message;
};

class TableRefuses : public ::testing::TestWithParam<BadTable> {};

TEST_P(TableRefuses, WithLine) {
  const Folder folder;
  expect_read_error(folder.file("t.xy", GetParam().content), GetParam().line, GetParam().message);
}

INSTANTIATE_TEST_SUITE_P(
    Errors, TableRefuses,
    ::testing::Values(BadTable{"empty", "", 0, "is empty"}, BadTable{"blank", "\n \n", 0, "no points"},
                      BadTable{"comments_only", "# a\n# b", 0, "no points"},
                      BadTable{"header_only", "x y\n", 0, "only a header"},
                      BadTable{"nan", "1 2\n3 nan\n", 2, "column 2: 'nan' is not a finite number"},
                      BadTable{"nan_in_first_line", "NaN 2\n3 4\n", 1, "column 1: 'NaN' is not a finite number"},
                      BadTable{"infinity", "1 2\n\n-inf 4\n", 3, "column 1: '-inf' is not a finite number"},
                      BadTable{"infinity_in_words", "1 2\nInfinity 4\n", 2, "not a finite number"},
                      BadTable{"infinity_as_only_line", "inf -Infinity\n", 1, "not a finite number"},
                      BadTable{"overflow", "1 2\n1e400 4\n", 2, "'1e400' is too large for a double"},
                      BadTable{"negative_overflow", "1 2\n1 -1e309\n", 2, "'-1e309' is too large for a double"},
                      BadTable{"hexadecimal", "1 2\n0x1p3 4\n", 2, "'0x1p3' is not a decimal number"},
                      BadTable{"hexadecimal_first", "0x1p3 0x1p4\n1 2\n", 1, "'0x1p3' is not a decimal number"},
                      BadTable{"decimal_comma", "1,5;2,5\n3,5;4,5\n", 1, "'1,5' is not a decimal number"},
                      BadTable{"word", "1 2\n3 four\n", 2, "'four' is not a decimal number"},
                      BadTable{"number_with_tail", "1 2\n3 4x\n", 2, "'4x' is not a decimal number"},
                      BadTable{"two_signs", "1 2\n3 +-4\n", 2, "'+-4' is not a decimal number"},
                      BadTable{"sign_only", "1 2\n3 -\n", 2, "'-' is not a decimal number"},
                      BadTable{"too_few", "1 2\n3\n", 2, "1 field, 2 are expected"},
                      BadTable{"too_many", "1 2\n3 4 5\n", 2, "3 fields, 2 are expected"},
                      BadTable{"height_missing", "1 2 3\n4 5\n", 2, "2 fields, column 3 is expected"},
                      BadTable{"one_column", "1\n2\n", 1, "1 field, column 2 is expected"},
                      BadTable{"empty_cell", "x,y\n1,2\n,4\n", 3, "column 1 is empty"},
                      BadTable{"empty_cell_between_tabs", "1\t2\t3\t4\n5\t\t7\t8\n", 2, "empty cell between tabs"},
                      BadTable{"empty_cell_before_a_tab", "1\t2\t3\n\t7\t8\t9\n", 2, "empty cell between tabs"},
                      BadTable{"unclosed_quote", "x,y\n1,\"2\n3,4\n", 2, "not closed"},
                      BadTable{"line_after_quoted_line_end", "n,x,y\n\"a\nb\",1,2\nc,3,d\n", 4, "'d' is not"},
                      BadTable{"utf16",
                               "\xff\xfe"
                               "1 2",
                               1, "UTF-16"},
                      BadTable{"control_characters_are_escaped", "1 2\n3 \x01z\n", 2, "'\\x01z'"}),
    [](const auto& test) { return std::string(test.param.name); });

TEST(Table, BinaryContentIsNoText) {
  const Folder folder;
  expect_read_error(folder.file("t.xy", std::string("\x7f"
                                                    "ELF\0\0\0",
                                                    7)),
                    1, "not text");
}

TEST(Table, LongLines) {
  const Folder folder;
  const std::string blanks(10000, ' '), zeros(10000, '0');
  const std::string path =
      folder.file("t.xy", blanks + "1" + blanks + "2" + blanks + "\n" + zeros + "3 ." + zeros + "4\n");
  EXPECT_EQ(read_points(path).xy, (Values{1, 2, 3, 0}));
  const std::string word(10000, 'a');
  expect_read_error(folder.file("bad.xy", "1 2\n3 " + word + "\n"), 2, "'aaaaaaaa");
  try {
    static_cast<void>(read_points(folder / "bad.xy"));
  } catch (const FileError& error) {
    EXPECT_LT(std::strlen(error.what()), 300U);  // the message quotes a piece of the word only
  }
}

/// Makes iostreams and, if the machine has such a locale, the C library write 1,5 for 1.5.
class CommaLocale {
 public:
  CommaLocale() : cpp_(std::locale()), c_(std::setlocale(LC_ALL, nullptr)) {
    for (const char* name : {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8", "fr_FR.utf8"}) {
      if (std::setlocale(LC_ALL, name) != nullptr) break;
    }
    std::locale::global(std::locale(std::locale(), new Comma));
  }
  ~CommaLocale() {
    std::locale::global(cpp_);
    std::setlocale(LC_ALL, c_.c_str());
  }
  CommaLocale(const CommaLocale&) = delete;
  CommaLocale& operator=(const CommaLocale&) = delete;

 private:
  struct Comma : std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
    char do_thousands_sep() const override { return '.'; }
    std::string do_grouping() const override { return "\3"; }
  };
  std::locale cpp_;
  std::string c_;
};

TEST(Locale, NumbersNeverDependOnIt) {
  const Folder folder;
  const CommaLocale comma;
  std::ostringstream control;
  control << 1234.5;
  ASSERT_EQ(control.str(), "1.234,5");  // the locale is in force: a writer that used it would fail below
  const PointSet points{{1234.5, -0.25, 1e6, 0.1}, {}, {}};
  for (const std::string format : {"xy", "csv", "xyz", "node"}) {
    const std::string path = folder / ("t." + format);
    write_points(path, points);
    EXPECT_NE(content_of(path).find("1234.5"), std::string::npos) << content_of(path);
    EXPECT_EQ(read_points(path).xy, points.xy) << format;
  }
}

}  // namespace
}  // namespace cadt::io::test
