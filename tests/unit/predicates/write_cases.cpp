// SPDX-License-Identifier: Apache-2.0
// Writes all cases to a file, for tests/unit/predicates/evaluate.cpp. usage: cadt-write-predicate-cases FILE
#include <cstdio>
#include <fstream>
#include <iostream>

#include "tests/unit/predicates/cases.hpp"
#include "tests/unit/verify/truth.hpp"

namespace {

using cadt::test::SignCase;

void write(std::ofstream& out, const std::vector<SignCase>& cases) {
  const std::uint64_t count = cases.size();
  out.write(reinterpret_cast<const char*>(&count), sizeof count);
  out.write(reinterpret_cast<const char*>(cases.data()), static_cast<std::streamsize>(count * sizeof cases[0]));
}

void write(std::ofstream& out, const cadt::test::SignSet& set) {
  const std::uint64_t length = set.name.size();
  out.write(reinterpret_cast<const char*>(&length), sizeof length);
  out << set.name;
  write(out, set.narrow);
  write(out, set.wide);
  write(out, set.floats);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: cadt-write-predicate-cases FILE\n";
    return 2;
  }
  std::ofstream out(argv[1], std::ios::binary);
  for (const std::string& name : cadt::test::file_sets()) {
    const auto folder = truth::hard_data();
    if (folder.empty() || !std::filesystem::exists(folder / name)) {
      std::cerr << name << " is missing and left out: set CADT_DATA_DIR\n";
      continue;
    }
    write(out, cadt::test::file_set(folder, name));
  }
  for (const std::string& name : cadt::test::generated_sets()) write(out, cadt::test::generated_set(name));
  for (const std::string& name : cadt::test::float_sets()) write(out, cadt::test::float_set(name));
  out.close();
  if (out) return 0;
  std::perror(argv[1]);
  return 1;
}
