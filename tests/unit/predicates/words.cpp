// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/predicates/words.hpp"

#include <array>

#include "common/points/device_points.hpp"

namespace cadt::test {

std::vector<std::uint32_t> words_of(Device& device, const std::vector<SignCase>& cases, KernelVariant build) {
  const auto count = static_cast<std::uint32_t>(cases.size());
  std::vector<std::uint32_t> words(cases.size());
  if (cases.empty()) return words;
  std::vector<double> points, most;
  for (const SignCase& c : cases) {
    for (const PlanePoint& p : c.points) points.push_back(p.x), points.push_back(p.y);
    most.push_back(c.most);
  }
  const auto upload = [&](const std::vector<double>& values) {
    auto buffer = device.allocate(values.size() * coordinate_bytes(device));
    const std::vector<float> floats(values.begin(), values.end());
    const void* const data = takes_floats_only(device) ? static_cast<const void*>(floats.data()) : values.data();
    device.write(*buffer, 0, data, buffer->bytes());
    return buffer;
  };
  const auto in = upload(points), bounds = upload(most), out = device.allocate(words.size() * 4);
  device.fill(*out, 0, out->bytes(), 0xA5A5A5A5u);  // no word is like this one: a case left out is seen
  const LaunchShape shape = device.shape();
  const std::uint32_t grain = shape.contiguous ? 64 : 1, items = (count + grain - 1) / grain;
  const std::array<Arg, 5> arguments = {Arg(in), Arg(bounds), Arg(out), Arg(count), Arg(grain)};
  device.launch(KernelId::cadt_predicate_probe, items, arguments, build);
  device.finish();
  device.read(*out, 0, words.data(), out->bytes());
  return words;
}

}  // namespace cadt::test
