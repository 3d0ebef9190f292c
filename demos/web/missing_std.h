#pragma once
// What Emscripten 3.1.6's standard library (that of LLVM 13) lacks of C++20. Included before every
// source by the build of the page alone, so that the sources need not know.

#include <atomic>
#include <bit>
#include <charconv>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <type_traits>
#include <version>

#if !defined(__cpp_lib_bit_cast)
namespace std {
template <class To, class From>
requires(sizeof(To) == sizeof(From) && is_trivially_copyable_v<To> &&
         is_trivially_copyable_v<From>) constexpr To bit_cast(const From& from) noexcept {
    return __builtin_bit_cast(To, from);
}
}  // namespace std
#endif

#if !defined(__cpp_lib_smart_ptr_for_overwrite)
namespace std {
template <class T>
requires is_unbounded_array_v<T> unique_ptr<T> make_unique_for_overwrite(size_t count) {
    return unique_ptr<T>(new remove_extent_t<T>[count]);
}
}  // namespace std
#endif

#if !defined(__cpp_lib_atomic_ref)
namespace std {
template <class T>
requires is_integral_v<T>
class atomic_ref {
  public:
    explicit atomic_ref(T& value) : value_(value) {}
    T fetch_or(T bits, memory_order order = memory_order_seq_cst) const noexcept {
        return __atomic_fetch_or(&value_, bits, int(order));
    }

  private:
    T& value_;
};
}  // namespace std
#endif

#if !defined(__cpp_lib_to_chars)
namespace std {
/// The fewest digits that read back as `value`, which are the digits of the real one; it may choose
/// between 100000 and 1e+05 otherwise.
inline to_chars_result to_chars(char* first, char* last, double value) {
    char text[32];
    for (int digits = 1; digits <= 17; ++digits) {
        snprintf(text, sizeof text, "%.*g", digits, value);
        if (strtod(text, nullptr) == value) {
            break;
        }
    }
    const size_t size = strlen(text);
    if (size > size_t(last - first)) {
        return {last, errc::value_too_large};
    }
    memcpy(first, text, size);
    return {first + size, errc{}};
}
}  // namespace std
#endif
