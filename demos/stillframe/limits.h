#pragma once
// What scenes may take from the machine, as the command line says it.

#include <cstdint>
#include <filesystem>
#include <string>

#include "demos/stillframe/outcome.h"
#include "engine/load.h"

namespace still::command {

/// What the machine has, or the control group of the process allows if that is less.
uint64_t machineMemoryBytes();

/// Options of every command that opens scenes.
struct Limits {
    bool allow_outside = false;  ///< see LoadOptions
    uint64_t max_memory_bytes = machineMemoryBytes();
};

/// "512M", "1.5G", "800000000": bytes, or with K, M, G, T by powers of 1024; at least 1M.
Outcome<uint64_t> parseBytes(const std::string& text);

LoadOptions loadOptions(const Limits& limits, const std::filesystem::path& cache_folder);

}  // namespace still::command
