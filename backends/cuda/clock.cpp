// SPDX-License-Identifier: Apache-2.0
#include "backends/cuda/clock.hpp"

namespace cadt::cuda {

CudaClock::~CudaClock() {
  const ContextScope scope(stream_->context());
  for (cudaEvent_t event : events_) ignore(cudaEventDestroy(event));
}

void CudaClock::record(std::size_t number) {
  const ContextScope scope(stream_->context());
  if (number == events_.size()) {
    cudaEvent_t event = nullptr;
    check_call(cudaEventCreate(&event), "cudaEventCreate");
    events_.push_back(event);
  }
  check_call(cudaEventRecord(events_[number], stream_->get()), "cudaEventRecord");
}

std::vector<double> CudaClock::read() {
  const ContextScope scope(stream_->context());
  stream_->wait();
  std::vector<double> result;
  result.reserve(pairs_);
  for (std::size_t pair = 0; pair < pairs_; ++pair) {
    float milliseconds = 0;
    check_call(cudaEventElapsedTime(&milliseconds, events_[2 * pair], events_[2 * pair + 1]), "cudaEventElapsedTime");
    result.push_back(static_cast<double>(milliseconds));
  }
  clear();
  return result;
}

}  // namespace cadt::cuda
