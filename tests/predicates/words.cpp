// SPDX-License-Identifier: Apache-2.0
#include "tests/predicates/words.hpp"

#include <array>

namespace cadt::test {

std::vector<std::uint32_t> words_of(Device& device, const std::vector<SignCase>& cases, KernelBuild build) {
  const auto count = static_cast<std::uint32_t>(cases.size());
  std::vector<std::uint32_t> words(cases.size());
  if (cases.empty()) return words;
  std::vector<Four> points;
  std::vector<double> most;
  for (const SignCase& c : cases) points.push_back(c.points), most.push_back(c.most);
  const auto in = device.allocate(points.size() * sizeof points[0]), bounds = device.allocate(most.size() * 8),
             out = device.allocate(words.size() * 4);
  device.write(*in, 0, points.data(), in->bytes());
  device.write(*bounds, 0, most.data(), bounds->bytes());
  device.fill(*out, 0, out->bytes(), 0xA5A5A5A5u);  // no word is like this one: a case left out is seen
  const LaunchShape shape = device.shape();
  const std::uint32_t grain = shape.contiguous ? 64 : 1, items = (count + grain - 1) / grain;
  const std::array<Arg, 5> arguments = {Arg(in), Arg(bounds), Arg(out), Arg(count), Arg(grain)};
  device.launch(KernelId::cadt_signs, items, arguments, build);
  device.finish();
  device.read(*out, 0, words.data(), out->bytes());
  return words;
}

}  // namespace cadt::test
