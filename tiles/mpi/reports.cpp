// SPDX-License-Identifier: Apache-2.0
#include "tiles/mpi/reports.hpp"

#include <bit>
#include <cstring>

namespace cadt::tiles::mpi {
namespace {

void append(Words& words, const std::string& text) {
  words.push_back(text.size());
  const std::size_t at = words.size();
  words.resize(at + (text.size() + sizeof words[0] - 1) / sizeof words[0]);
  if (!text.empty()) std::memcpy(words.data() + at, text.data(), text.size());
}

/// Takes what append() has put there from the front.
class Reader {
 public:
  explicit Reader(std::span<const std::uint64_t> words) : words_(words) {}
  [[nodiscard]] bool at_end() const noexcept { return words_.empty(); }
  std::uint64_t number() {
    const std::uint64_t word = words_.front();
    words_ = words_.subspan(1);
    return word;
  }
  double real() { return std::bit_cast<double>(number()); }
  std::string text() {
    std::string text(number(), '\0');
    if (!text.empty()) std::memcpy(text.data(), words_.data(), text.size());
    words_ = words_.subspan((text.size() + sizeof words_[0] - 1) / sizeof words_[0]);
    return text;
  }

 private:
  std::span<const std::uint64_t> words_;
};

}  // namespace

void append(Words& words, std::uint32_t node, const NodeReport& report) {
  const NodeTimes& t = report.times;
  words.insert(words.end(),
               {node, report.points, report.triangles, report.open, report.device, report.resumed ? 1U : 0U});
  for (const double seconds : {t.read, t.compute, t.download, t.consume, t.write})
    words.push_back(std::bit_cast<std::uint64_t>(seconds));
  words.push_back(report.statistics.milliseconds.size());
  for (const auto& [name, milliseconds] : report.statistics.milliseconds) {
    append(words, name);
    words.push_back(std::bit_cast<std::uint64_t>(milliseconds));
  }
}

void read_reports(std::span<const std::uint64_t> words, std::vector<NodeReport>& reports) {
  Reader reader(words);
  while (!reader.at_end()) {
    NodeReport& report = reports.at(reader.number());
    report.points = reader.number(), report.triangles = reader.number(), report.open = reader.number();
    report.device = static_cast<unsigned>(reader.number());
    report.resumed = reader.number() != 0;
    NodeTimes& t = report.times;
    for (double* seconds : {&t.read, &t.compute, &t.download, &t.consume, &t.write}) *seconds = reader.real();
    auto& phases = report.statistics.milliseconds;
    phases.resize(reader.number());
    for (auto& [name, milliseconds] : phases) name = reader.text(), milliseconds = reader.real();
  }
}

Words pack(const NodeSums& sums) {
  const auto dimension = static_cast<std::uint64_t>(static_cast<std::int64_t>(sums.dimension));
  return {sums.points,          sums.distinct, sums.triangles, sums.hull_edges,
          sums.certified_edges, dimension,     sums.hash.high, sums.hash.low};
}

NodeSums unpack_sums(std::span<const std::uint64_t> words) {
  NodeSums sums;
  sums.points = words[0], sums.distinct = words[1], sums.triangles = words[2], sums.hull_edges = words[3];
  sums.certified_edges = words[4];
  sums.dimension = static_cast<int>(static_cast<std::int64_t>(words[5]));
  sums.hash.high = words[6], sums.hash.low = words[7];
  return sums;
}

std::vector<std::string> gather_texts(Communicator& ranks, const std::string& text) {
  Words words;
  append(words, text);
  const Exchanged all = ranks.all_gather(words);
  std::vector<std::string> texts;
  for (int r = 0; r < ranks.size(); ++r) texts.push_back(Reader(all.from(r)).text());
  return texts;
}

}  // namespace cadt::tiles::mpi
