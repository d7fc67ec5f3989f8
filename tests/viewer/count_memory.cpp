// SPDX-License-Identifier: MIT
// Loaded before a program (LD_PRELOAD): how many bytes were asked for and not given back, as two numbers of eight bytes
// in the file that DARKROOM_LIVE_BYTES names: by its own code and the standard library, and by all others, such as
// drivers and the desktop's libraries. For glibc.
#include <fcntl.h>
#include <link.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <new>
#include <string_view>

extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
void* __libc_realloc(void* memory, std::size_t size);
void __libc_free(void* memory);
}

namespace {

struct Range {
    std::uintptr_t begin = 0, end = 0;
};
constinit std::array<Range, 2> counted{};                   ///< code of the program, and of the standard library
using Counters = std::array<std::atomic<std::int64_t>, 2>;  ///< its own, of others
constinit Counters nowhere{};
constinit Counters* live = &nowhere;

/// Before every piece of memory.
struct Header {
    std::size_t size, offset;
    std::uint64_t counter;  ///< its number
    std::uint64_t mark;
};
constexpr std::uint64_t our_mark = 0x64617266726f6f6d;

int note_range(dl_phdr_info* info, std::size_t, void* number) {
    // The program is the first, and has no name.
    const int at = (*static_cast<int*>(number))++ == 0 ? 0 : 1;
    if (at == 1 && std::string_view(info->dlpi_name).find("/libstdc++.so") == std::string_view::npos) return 0;
    Range range{~std::uintptr_t{0}, 0};
    for (int i = 0; i < info->dlpi_phnum; ++i) {
        const auto& part = info->dlpi_phdr[i];
        if (part.p_type != PT_LOAD) continue;
        range.begin = std::min(range.begin, info->dlpi_addr + part.p_vaddr);
        range.end = std::max(range.end, info->dlpi_addr + part.p_vaddr + part.p_memsz);
    }
    counted[static_cast<std::size_t>(at)] = range;
    return 0;
}

[[gnu::constructor]] void begin() {
    const char* const name = std::getenv("DARKROOM_LIVE_BYTES");
    const int file = name == nullptr ? -1 : open(name, O_RDWR | O_CREAT | O_CLOEXEC, 0600);
    if (file < 0 || ftruncate(file, sizeof *live) != 0) return;
    void* const shared = mmap(nullptr, sizeof *live, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    close(file);
    if (shared == MAP_FAILED) return;
    live = new (shared) Counters{};
    int number = 0;
    dl_iterate_phdr(note_range, &number);
}

Header* header_of(void* memory) {
    auto* const header = reinterpret_cast<Header*>(static_cast<char*>(memory) - sizeof(Header));
    return header->mark == our_mark ? header : nullptr;
}

void* give(std::size_t size, std::size_t alignment, const void* caller) {
    const std::size_t offset = std::max(alignment, sizeof(Header));
    void* const whole = size > PTRDIFF_MAX - offset         ? nullptr
                        : alignment <= alignof(std::max_align_t) ? __libc_malloc(size + offset)
                                                            : __libc_memalign(alignment, size + offset);
    if (whole == nullptr) {
        errno = ENOMEM;
        return nullptr;
    }
    char* const memory = static_cast<char*>(whole) + offset;
    const auto from = reinterpret_cast<std::uintptr_t>(caller);
    const bool is_own =
        std::ranges::any_of(counted, [&](const Range& range) { return from >= range.begin && from < range.end; });
    const std::uint64_t counter = is_own ? 0 : 1;
    new (memory - sizeof(Header)) Header{size, offset, counter, our_mark};
    (*live)[counter] += static_cast<std::int64_t>(size);
    return memory;
}

void take(void* memory) {
    Header* const header = memory == nullptr ? nullptr : header_of(memory);
    if (header == nullptr) return __libc_free(memory);
    (*live)[header->counter] -= static_cast<std::int64_t>(header->size);
    header->mark = 0;
    __libc_free(static_cast<char*>(memory) - header->offset);
}

void* give_or_throw(std::size_t size, std::size_t alignment, const void* caller) {
    void* const memory = give(size, alignment, caller);
    if (memory == nullptr) throw std::bad_alloc();
    return memory;
}

}  // namespace

extern "C" {
void* malloc(std::size_t size) { return give(size, 1, __builtin_return_address(0)); }
void free(void* memory) { take(memory); }
void* calloc(std::size_t count, std::size_t each) {
    std::size_t size = 0;
    if (__builtin_mul_overflow(count, each, &size)) size = SIZE_MAX;
    void* const memory = give(size, 1, __builtin_return_address(0));
    return memory == nullptr ? nullptr : std::memset(memory, 0, size);
}
void* realloc(void* memory, std::size_t size) {
    const Header* const header = memory == nullptr ? nullptr : header_of(memory);
    if (memory != nullptr && header == nullptr) return __libc_realloc(memory, size);
    void* const grown = give(size, 1, __builtin_return_address(0));
    if (grown == nullptr || header == nullptr) return grown;
    std::memcpy(grown, memory, std::min(size, header->size));
    take(memory);
    return grown;
}
void* memalign(std::size_t alignment, std::size_t size) { return give(size, alignment, __builtin_return_address(0)); }
void* aligned_alloc(std::size_t alignment, std::size_t size) {
    return give(size, alignment, __builtin_return_address(0));
}
int posix_memalign(void** memory, std::size_t alignment, std::size_t size) {
    *memory = give(size, alignment, __builtin_return_address(0));
    return *memory == nullptr ? ENOMEM : 0;
}
std::size_t malloc_usable_size(void* memory) { return memory == nullptr ? 0 : header_of(memory)->size; }
}

// The standard library's other forms call these.
void* operator new(std::size_t size) { return give_or_throw(size, 1, __builtin_return_address(0)); }
void* operator new[](std::size_t size) { return give_or_throw(size, 1, __builtin_return_address(0)); }
void* operator new(std::size_t size, std::align_val_t alignment) {
    return give_or_throw(size, static_cast<std::size_t>(alignment), __builtin_return_address(0));
}
void operator delete(void* memory) noexcept { take(memory); }
void operator delete(void* memory, std::size_t) noexcept { take(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { take(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { take(memory); }
