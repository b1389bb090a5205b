// A GPU by CUDA. A component of its own, which grit opens where a run asks for a GPU, so that grit needs no CUDA elsewhere.
#include <cuda_runtime.h>

#include <map>
#include <string>

#include "device/device.hpp"
#include "grit/error.hpp"
#include "threads/chunks.hpp"

namespace grit {
namespace {

void expect(cudaError_t status, const std::string& what) {
  if (status == cudaSuccess) return;
  throw Error("the GPU failed to " + what + ": " + cudaGetErrorString(status));
}

/// A block is a chunk. Extremes are joined in pairs, always the same ones.
__global__ void move_on_gpu(DeviceMotion motion) {
  __shared__ DeviceChunk parts[chunk_bodies];
  const std::uint32_t own = threadIdx.x, body = blockIdx.x * blockDim.x + own;
  if (body < motion.bodies) parts[own] = motion(body);
  for (std::uint32_t step = chunk_bodies / 2; step > 0; step /= 2) {
    __syncthreads();
    if (own < step && body + step < motion.bodies) parts[own] = DeviceChunk::join(parts[own], parts[own + step]);
  }
  if (own == 0) motion.chunk[blockIdx.x] = parts[0];
}

class CudaDevice final : public Device {
 public:
  CudaDevice() {
    int count = 0;
    if (const cudaError_t status = cudaGetDeviceCount(&count); status != cudaSuccess || count == 0)
      throw FileError(std::string("found no GPU: ") + (count == 0 ? "none is there" : cudaGetErrorString(status)) +
                  "; run it without --device gpu");
    cudaDeviceProp properties{};
    expect(cudaGetDeviceProperties(&properties, 0), "describe itself");
    name_ = properties.name;
  }
  ~CudaDevice() override {
    for (const auto& [image, one] : kernels_) cudaLibraryUnload(one.library);
  }
  CudaDevice(const CudaDevice&) = delete;
  CudaDevice& operator=(const CudaDevice&) = delete;

  std::string name() const override { return name_; }
  void* allocate(std::size_t bytes) override {
    void* memory = nullptr;
    if (bytes == 0) return memory;
    if (const cudaError_t status = cudaMalloc(&memory, bytes); status == cudaErrorMemoryAllocation) {
      std::size_t left = 0, all = 0;
      cudaMemGetInfo(&left, &all);
      throw Error("the GPU has " + std::to_string(left >> 20) + " MiB of memory left, needed are " +
                  std::to_string(bytes >> 20) + " MiB more; use fewer bodies, or run it without --device gpu");
    } else {
      expect(status, "allocate memory");
    }
    return memory;
  }
  void release(void* memory) noexcept override { cudaFree(memory); }
  void write(void* to, const void* from, std::size_t bytes) override {
    expect(cudaMemcpy(to, from, bytes, cudaMemcpyHostToDevice), "take data");
  }
  void read(void* to, const void* from, std::size_t bytes) override {
    expect(cudaMemcpy(to, from, bytes, cudaMemcpyDeviceToHost), "step the bodies");
  }
  void evaluate(const ContactLaw&, const DeviceLaw& law, const DevicePairs& pairs, const void* parameters,
                std::uint32_t bodies) override {
    if (bodies == 0) return;
    DevicePairs given = pairs;
    std::uint32_t materials = law.materials;
    unsigned features = law.features;
    void* arguments[] = {&given, &parameters, &materials, &features, &bodies};
    constexpr unsigned block = 128;
    expect(cudaLaunchKernel(reinterpret_cast<const void*>(kernel_of(law)), dim3((bodies + block - 1) / block),
                            dim3(block), arguments, 0, nullptr),
           "start the kernel of the contact law");
  }
  void move(const DeviceMotion& motion) override {
    if (motion.bodies == 0) return;
    move_on_gpu<<<static_cast<unsigned>(chunks_of(motion.bodies)), chunk_bodies>>>(motion);
    expect(cudaGetLastError(), "start the kernel of the motion");
  }

 private:
  struct Loaded {
    cudaLibrary_t library;
    cudaKernel_t kernel;
  };

  cudaKernel_t kernel_of(const DeviceLaw& law) {
    if (const auto known = kernels_.find(law.ptx.data()); known != kernels_.end()) return known->second.kernel;
    if (law.ptx.empty())
      throw Error("the contact law has no code for GPUs; build its plugin where nvcc is, or run it without --device gpu");
    Loaded one{};
    expect(cudaLibraryLoadData(&one.library, law.ptx.data(), nullptr, nullptr, 0, nullptr, nullptr, 0),
           "load the kernel of the contact law");
    expect(cudaLibraryEnumerateKernels(&one.kernel, 1, one.library), "find the kernel of the contact law");
    kernels_.emplace(law.ptx.data(), one);
    return one.kernel;
  }

  std::string name_;
  std::map<const char*, Loaded> kernels_;  // by image
};

}  // namespace
}  // namespace grit

extern "C" __attribute__((visibility("default"))) grit::Device* GRIT_CUDA_ENTRY() { return new grit::CudaDevice; }
