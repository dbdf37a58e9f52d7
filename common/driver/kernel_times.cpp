// SPDX-License-Identifier: Apache-2.0
#include "common/driver/kernel_times.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <string>
#include <utility>

namespace cadt {

std::vector<KernelTime> KernelTimes::sums() {
  if (clock_ == nullptr) return {};
  const std::vector<double> milliseconds = clock_->read();
  if (milliseconds.size() != launched_.size())
    throw InternalError("the device timed " + std::to_string(milliseconds.size()) + " of " +
                        std::to_string(launched_.size()) + " launches; please report this");
  std::array<KernelTime, kernel_count + 2> all;
  for (std::size_t i = 0; i < launched_.size(); ++i) {
    KernelTime& one = all[launched_[i]];
    ++one.launches;
    one.milliseconds += milliseconds[i];
  }
  launched_.clear();
  std::vector<KernelTime> result;
  for (std::size_t what = 0; what < all.size(); ++what) {
    if (all[what].launches == 0) continue;
    all[what].name = what == sort ? "sort" : what == scan ? "scan" : kernel_names[what];
    result.push_back(std::move(all[what]));
  }
  std::ranges::stable_sort(result, std::ranges::greater{}, &KernelTime::milliseconds);
  return result;
}

}  // namespace cadt
