// File: header, one ArrayInfo per array, table, arrays. The table starts with the key and the
// inputs, and goes on with the model (model_format). Little-endian machines write and read it; on
// others `byte_order` reads differently, so that they make their own.

#include "engine/internal/model_cache.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstring>
#include <fstream>
#include <random>
#include <system_error>
#include <thread>
#include <vector>

#include "engine/hash.h"
#include "engine/internal/model_format.h"
#include "rasterizer/workers.h"

namespace still {
namespace {

namespace fs = std::filesystem;

constexpr std::array<char, 8> kMagic{'S', 'T', 'I', 'L', 'L', 'O', 'B', 'J'};
constexpr uint32_t kFormat = 2;
constexpr uint32_t kByteOrder = 0x01020304;
constexpr const char* kExtension = ".model";
constexpr const char* kUnfinished = ".unfinished";

struct Header {
    std::array<char, 8> magic = kMagic;
    uint32_t format = kFormat, byte_order = kByteOrder;
    uint64_t program = 0;  ///< programHash()
    uint64_t array_count = 0, table_bytes = 0;
    uint64_t hash = 0;  ///< of ArrayInfos and table
};

/// Another program, another number: it may make other models of the same files. 0: unknown.
uint64_t programHash() {
    static const uint64_t hash = inspect("/proc/self/exe").hash;
    return hash;
}

/// Calls task(i) for all i < count by several threads; false when any of them gives false.
template <class Task>
bool all(size_t count, const Task& task) {
    constexpr int kMaxThreads = 8;
    Workers workers(std::clamp(int(std::thread::hardware_concurrency()), 1,
                               std::clamp(int(count), 1, kMaxThreads)));
    std::atomic<bool> good = true;
    workers.parallelFor(int(count), 1, [&](int begin, int end, int) {
        for (int i = begin; i < end && good; ++i) {
            try {
                if (!task(size_t(i))) {
                    good = false;
                }
            } catch (const std::exception&) {  // no memory
                good = false;
            }
        }
    });
    return good;
}

template <class T>
bool readAs(std::istream& stream, std::vector<T>& elements, uint64_t count) {
    elements.resize(size_t(count));
    return bool(
        stream.read(reinterpret_cast<char*>(elements.data()), std::streamsize(count * sizeof(T))));
}

/// The start of the file up to the arrays, checked.
struct Front {
    std::vector<ArrayInfo> arrays;
    std::vector<char> table;
    uint64_t bytes = 0;  ///< of header, arrays' infos and table

    std::string_view infoBytes() const {
        return {reinterpret_cast<const char*>(arrays.data()), arrays.size() * sizeof(ArrayInfo)};
    }
    std::string_view text() const { return {table.data(), table.size()}; }
    uint64_t hash() const { return hashBytes(text(), hashBytes(infoBytes())); }

    bool read(std::istream& stream, uint64_t file_bytes);
};

bool Front::read(std::istream& stream, uint64_t file_bytes) {
    Header header;
    const Header expected;
    if (!stream.read(reinterpret_cast<char*>(&header), sizeof header) ||
        header.magic != expected.magic || header.format != expected.format ||
        header.byte_order != expected.byte_order || header.program != programHash() ||
        header.array_count > file_bytes / sizeof(ArrayInfo) || header.table_bytes > file_bytes ||
        !readAs(stream, arrays, header.array_count) || !readAs(stream, table, header.table_bytes)) {
        return false;
    }
    bytes = sizeof header + infoBytes().size() + table.size();
    if (bytes > file_bytes) {
        return false;
    }
    uint64_t left = file_bytes - bytes;
    for (const ArrayInfo& array : arrays) {
        if (array.bytes > left) {
            return false;
        }
        left -= array.bytes;
    }
    return left == 0 && hash() == header.hash;
}

/// Fills the arrays, by several threads, each through a stream of its own.
bool fillArrays(const fs::path& file, uint64_t first_byte, const std::vector<ModelFill>& fills) {
    std::vector<uint64_t> starts;
    for (const ModelFill& fill : fills) {
        starts.push_back(first_byte);
        first_byte += fill.info.bytes;
    }
    return all(fills.size(), [&](size_t i) {
        std::ifstream stream(file, std::ios::binary);
        return stream.seekg(std::streamoff(starts[i])) && fills[i].run(stream);
    });
}

std::optional<ObjModel> readModel(const fs::path& file, const std::string& key) {
    std::ifstream stream(file, std::ios::binary);
    std::error_code error;
    const uint64_t file_bytes = stream ? fs::file_size(file, error) : 0;
    Front front;
    if (!stream || error || !front.read(stream, file_bytes)) {
        return std::nullopt;
    }
    ModelOrigin origin;
    std::optional<ObjModel> model(std::in_place);
    const std::vector<ModelFill> fills = unflatten(front.text(), front.arrays, origin, *model);
    const auto unchanged = [&](size_t i) {
        return inspect(origin.inputs[i].file) == origin.inputs[i].input;
    };
    if (fills.empty() || origin.key != key || !all(origin.inputs.size(), unchanged) ||
        !fillArrays(file, front.bytes, fills) || !isSound(*model)) {
        return std::nullopt;
    }
    for (const InputLog::Entry& entry : origin.inputs) {
        model->files.push_back(entry.file);
    }
    return model;
}

bool writeModel(const fs::path& file, const ModelOrigin& origin, const ObjModel& model) {
    const FlatModel flat = flatten(origin, model);
    Front front;
    front.arrays.resize(flat.arrays.size());
    front.table.assign(flat.table.begin(), flat.table.end());
    all(flat.arrays.size(), [&](size_t i) {
        front.arrays[i] = flat.arrays[i].info();
        return true;
    });
    Header header;
    header.program = programHash();
    header.array_count = front.arrays.size();
    header.table_bytes = front.table.size();
    header.hash = front.hash();
    std::ofstream stream(file, std::ios::binary);
    stream.write(reinterpret_cast<const char*>(&header), sizeof header);
    stream << front.infoBytes() << front.text();
    for (const FlatArray& array : flat.arrays) {
        stream << array.bytes;
    }
    stream.close();
    return bool(stream);
}

}  // namespace

ModelCache::ModelCache(fs::path folder, const fs::path& obj, const FileAccess& access)
    : folder_(std::move(folder)) {
    std::error_code error;
    key_ = fs::absolute(obj, error).string() + '\n' + obj.string() + '\n' + access.key();
    file_ = folder_ / (hex(hashBytes(key_)) + kExtension);
}

std::optional<ObjModel> ModelCache::load() const {
    try {
        std::optional<ObjModel> model = readModel(file_, key_);
        std::error_code ignored;
        if (model) {  // used now: pruneModels() spares it
            fs::last_write_time(file_, fs::file_time_type::clock::now(), ignored);
        }
        return model;
    } catch (const std::exception&) {  // no memory
        return std::nullopt;
    }
}

void ModelCache::store(const ObjModel& model, const InputLog& log) const {
    // Reading less than this takes no time to speak of.
    constexpr uint64_t kSmallestInput = uint64_t{1} << 20;
    const ModelOrigin origin{key_, log.entries()};
    uint64_t input_bytes = 0;
    for (const InputLog::Entry& entry : origin.inputs) {
        input_bytes += entry.input.bytes;
    }
    if (input_bytes < kSmallestInput || programHash() == 0) {
        return;
    }
    try {
        std::error_code ignored;
        fs::create_directories(folder_, ignored);
        std::random_device random;
        fs::path unfinished = file_;
        unfinished += "." + hex(uint64_t{random()} << 32 | random()) + kUnfinished;
        if (writeModel(unfinished, origin, model)) {
            fs::rename(unfinished, file_, ignored);
        }
        fs::remove(unfinished, ignored);
        pruneModels(folder_, kModelCacheBytes);
    } catch (const std::exception&) {
        // The next run reads the files again.
    }
}

void pruneModels(const fs::path& folder, uint64_t limit_bytes) {
    constexpr auto kAbandoned = std::chrono::hours(1);
    struct Entry {
        fs::file_time_type time;
        uint64_t bytes;
        fs::path file;
    };
    std::vector<Entry> entries;
    std::error_code ignored;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored)) {
        const fs::file_time_type time = entry.last_write_time(ignored);
        if (entry.path().extension() == kExtension) {
            entries.push_back({time, entry.file_size(ignored), entry.path()});
        } else if (entry.path().extension() == kUnfinished &&
                   time < fs::file_time_type::clock::now() - kAbandoned) {
            fs::remove(entry.path(), ignored);
        }
    }
    std::sort(entries.begin(), entries.end(),
              [](const Entry& a, const Entry& b) { return a.time > b.time; });
    uint64_t total = 0;
    for (const Entry& entry : entries) {
        total += entry.bytes;
        if (total > limit_bytes) {
            fs::remove(entry.file, ignored);
        }
    }
}

}  // namespace still
