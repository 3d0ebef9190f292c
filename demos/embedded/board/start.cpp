// From reset to main() on a Cortex-M with an FPU, and what the program asks of its platform, over
// semihosting: the debugger, or the emulator, prints and ends the program.

#include <cstddef>
#include <cstdint>
#include <cstring>

#include "line.h"
#include "platform.h"
#include "run.h"

extern "C" {
// Set by board.ld.
extern uint32_t stack_begin[], stack_end[], data_load[], data_begin[], data_end[], bss_begin[],
    bss_end[];
extern void (*init_array_begin[])();
extern void (*init_array_end[])();

void resetHandler();
void faultHandler();
}

namespace {

constexpr uint32_t kUntouched = 0x57494C4C;  // what the stack is filled with

// Semihosting: operations, and the reasons to end the program.
constexpr uint32_t kWriteText = 0x04, kExit = 0x18;
constexpr uint32_t kApplicationExit = 0x20026, kRunTimeError = 0x20023;

void callHost(uint32_t operation, uint32_t parameter) {
    register uint32_t r0 asm("r0") = operation;
    register uint32_t r1 asm("r1") = parameter;
    asm volatile("bkpt 0xAB" : "+r"(r0) : "r"(r1) : "memory");
}

[[noreturn]] void endProgram(uint32_t reason) {
    for (;;) {
        callHost(kExit, reason);
    }
}

size_t stackBytesUsed() {
    const uint32_t* lowest = stack_begin;
    while (*lowest == kUntouched) {
        ++lowest;
    }
    return size_t(stack_end - lowest) * sizeof(uint32_t);
}

}  // namespace

namespace spin {

void print(std::string_view text) {
    char line[128];
    const size_t length = text.size() < sizeof(line) ? text.size() : sizeof(line) - 1;
    std::memcpy(line, text.data(), length);
    line[length] = 0;
    callHost(kWriteText, uint32_t(uintptr_t(line)));
}

void fail(std::string_view line) {
    print("error: ");
    print(line);
    print("\n");
    endProgram(kRunTimeError);
}

}  // namespace spin

// What libstdc++ would throw ends the program: exceptions would bring 60 KB of unwinder along.
namespace std {
void __throw_length_error(const char*) {
    spin::fail("a container became too long");
}
void __throw_bad_alloc() {
    spin::fail("there is not enough memory");
}
void __throw_out_of_range_fmt(const char*, ...) {
    spin::fail("a place in a container is out of range");
}
void __throw_bad_array_new_length() {
    spin::fail("an array became too long");
}
}  // namespace std

extern "C" {

void __cxa_pure_virtual() {
    spin::fail("a pure virtual function was called");
}

void faultHandler() {
    spin::fail("a fault: the stack has overflowed, or memory is accessed that is not there");
}

/// The first words of flash: the stack's end, then the handlers of reset, NMI and faults.
[[gnu::section(".vectors"), gnu::used]] const void* const vectors[16] = {
    stack_end,
    reinterpret_cast<const void*>(resetHandler),
    reinterpret_cast<const void*>(faultHandler),
    reinterpret_cast<const void*>(faultHandler),
    reinterpret_cast<const void*>(faultHandler),
    reinterpret_cast<const void*>(faultHandler),
    reinterpret_cast<const void*>(faultHandler),
};

void resetHandler() {
    // The FPU is off after reset, and compiled code may use it anywhere: before all else.
    volatile uint32_t* const coprocessor_access = reinterpret_cast<uint32_t*>(0xE000ED88);
    *coprocessor_access = *coprocessor_access | 0xFu << 20;
    asm volatile("dsb\n isb" ::: "memory");

    const uint32_t* here = static_cast<const uint32_t*>(__builtin_frame_address(0));
    for (volatile uint32_t* word = stack_begin; word < here - 64; ++word) {
        *word = kUntouched;
    }
    std::memcpy(data_begin, data_load, size_t(data_end - data_begin) * sizeof(uint32_t));
    std::memset(bss_begin, 0, size_t(bss_end - bss_begin) * sizeof(uint32_t));
    for (void (**initialiser)() = init_array_begin; initialiser < init_array_end; ++initialiser) {
        (*initialiser)();
    }
    spin::run(still::SimdTarget::scalar, 1);
    spin::Line line;
    spin::print((line << "stack " << stackBytesUsed() << " of "
                      << size_t(stack_end - stack_begin) * sizeof(uint32_t) << " bytes\n")
                    .text());
    endProgram(kApplicationExit);
}

}  // extern "C"
