// Arrays that start on a cache line, so that quads load aligned.
#pragma once

#include <cstddef>
#include <new>
#include <vector>

namespace gimpslope {

constexpr std::size_t kCacheLine = 64;  // bytes

template <class T>
struct CacheAligned {
  using value_type = T;
  static constexpr std::align_val_t line{kCacheLine};

  CacheAligned() = default;
  template <class U>
  CacheAligned(const CacheAligned<U>&) {}

  T* allocate(std::size_t n) { return static_cast<T*>(::operator new(n * sizeof(T), line)); }
  void deallocate(T* memory, std::size_t) { ::operator delete(memory, line); }
  bool operator==(const CacheAligned&) const { return true; }
};

template <class T>
using Buffer = std::vector<T, CacheAligned<T>>;

}  // namespace gimpslope
