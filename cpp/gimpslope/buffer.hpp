// Arrays that start on a cache line, so that quads load aligned; large ones on huge pages where the
// system has them on demand, since the points of a fine grid lie on more small ones than the
// processor remembers.
#pragma once

#include <cstddef>
#include <new>
#include <vector>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace gimpslope {

constexpr std::size_t kCacheLine = 64;                   // bytes
constexpr std::size_t kHugePage = std::size_t{1} << 21;  // bytes

template <class T>
struct CacheAligned {
  using value_type = T;
  CacheAligned() = default;
  template <class U>
  CacheAligned(const CacheAligned<U>&) {}

  T* allocate(std::size_t n) {
    void* memory = ::operator new(n * sizeof(T), alignment(n));
#if defined(__linux__) && defined(MADV_HUGEPAGE)
    // Advice alone: nothing is lost where it is not taken.
    if (n * sizeof(T) >= kHugePage) madvise(memory, n * sizeof(T), MADV_HUGEPAGE);
#endif
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, std::size_t n) { ::operator delete(memory, alignment(n)); }
  bool operator==(const CacheAligned&) const { return true; }

 private:
  static std::align_val_t alignment(std::size_t n) {
    return std::align_val_t{n * sizeof(T) < kHugePage ? kCacheLine : kHugePage};
  }
};

template <class T>
using Buffer = std::vector<T, CacheAligned<T>>;

}  // namespace gimpslope
