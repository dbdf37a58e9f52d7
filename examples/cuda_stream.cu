// SPDX-License-Identifier: Apache-2.0
// Points that a kernel makes, their mesh, and a kernel that reads the mesh: all on one stream, nothing copied to the
// host but one number. Ends with 77 where there is no GPU.
//
// usage: example-cuda-stream [points]
#include <cadt/cadt.hpp>

#include <cuda_runtime.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <stdexcept>

namespace {

constexpr int no_gpu = 77;  // SKIP_RETURN_CODE of the test
constexpr unsigned block = 256;

void check(cudaError_t code) {
  if (code != cudaSuccess) throw std::runtime_error(cudaGetErrorString(code));
}

unsigned blocks_for(std::size_t n) { return static_cast<unsigned>((n + block - 1) / block); }

/// A number in [0, 1) from a counter (S. Vigna's mixing function of SplitMix64).
__device__ double uniform(unsigned long long i) {
  unsigned long long z = (i + 1) * 0x9e3779b97f4a7c15ULL;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

/// The corners of the unit square, then points in it: the area of the mesh is 1.
__global__ void make_points(double2* points, std::size_t n) {
  const std::size_t i = blockIdx.x * std::size_t{blockDim.x} + threadIdx.x;
  if (i >= n) return;
  points[i] = i < 4 ? make_double2(static_cast<double>(i % 2), static_cast<double>(i / 2))
                    : make_double2(uniform(2 * i), uniform(2 * i + 1));
}

__global__ void sum_areas(const double2* points, const int* triangles, std::size_t count, double* sum) {
  double area = 0;
  for (std::size_t t = blockIdx.x * std::size_t{blockDim.x} + threadIdx.x; t < count;
       t += gridDim.x * std::size_t{blockDim.x}) {
    const double2 a = points[triangles[3 * t]], b = points[triangles[3 * t + 1]], c = points[triangles[3 * t + 2]];
    area += 0.5 * ((b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y));
  }
  atomicAdd(sum, area);
}

/// \throws std::exception if anything fails
bool run(std::size_t n) {
  cudaStream_t stream = nullptr;
  check(cudaStreamCreateWithFlags(&stream, cudaStreamNonBlocking));
  double2* points = nullptr;
  double* sum = nullptr;
  check(cudaMallocAsync(&points, n * sizeof *points, stream));
  check(cudaMallocAsync(&sum, sizeof *sum, stream));
  check(cudaMemsetAsync(sum, 0, sizeof *sum, stream));
  make_points<<<blocks_for(n), block, 0, stream>>>(points, n);
  check(cudaGetLastError());

  double area = 0;
  {
    cadt::Options options;
    options.backend = cadt::Backend::cuda;
    options.queue = stream;                    // all work of the library is put here, behind make_points
    options.order = cadt::Order::fast;         // the same triangles, in the order in which the device left them
    cadt::Triangulator triangulator(options);  // kept by a program that triangulates again and again
    const cadt::DeviceTriangulation mesh = triangulator.triangulate(cadt::DevicePoints{.x = points, .size = n});

    sum_areas<<<512, block, 0, stream>>>(points, static_cast<const int*>(mesh.triangles()), mesh.number_of_triangles(),
                                         sum);
    check(cudaGetLastError());
    check(cudaMemcpyAsync(&area, sum, sizeof area, cudaMemcpyDeviceToHost, stream));
    check(cudaStreamSynchronize(stream));
    std::printf("points      %zu\ntriangles   %zu\nduplicates  %zu\narea        %.12f\ndevice      %s\n", n,
                mesh.number_of_triangles(), mesh.number_of_duplicates(), area, triangulator.device().name.c_str());
  }  // mesh and triangulator go before the stream
  check(cudaFreeAsync(points, stream));
  check(cudaFreeAsync(sum, stream));
  check(cudaStreamSynchronize(stream));
  check(cudaStreamDestroy(stream));
  return std::abs(area - 1.0) < 1e-9;
}

}  // namespace

int main(int count, char** values) {
  int devices = 0;
  if (cudaGetDeviceCount(&devices) != cudaSuccess || devices == 0) {
    std::fprintf(stderr, "example-cuda-stream: no CUDA device\n");
    return no_gpu;
  }
  try {
    const std::size_t n = count > 1 ? std::strtoul(values[1], nullptr, 10) : 1'000'000;
    if (n < 4) throw std::runtime_error("at least the four corners are needed");
    return run(n) ? EXIT_SUCCESS : EXIT_FAILURE;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "example-cuda-stream: %s\n", error.what());
    return EXIT_FAILURE;
  }
}
