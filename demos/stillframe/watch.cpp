#include "demos/stillframe/watch.h"

#include <chrono>
#include <system_error>
#include <thread>

namespace still::command {

void Watch::add(const std::vector<std::string>& files) {
    for (const std::string& file : files) {
        files_.try_emplace(file, stateOf(file));
    }
}

bool Watch::changed() {
    bool any = false;
    for (auto& [file, state] : files_) {
        const State now = stateOf(file);
        any |= now != state;
        state = now;
    }
    return any;
}

void Watch::wait() {
    using std::chrono::milliseconds;
    while (!changed()) {
        std::this_thread::sleep_for(milliseconds(200));
    }
    do {
        std::this_thread::sleep_for(milliseconds(50));
    } while (changed());
}

Watch::State Watch::stateOf(const std::string& file) {
    std::error_code error;
    State state;
    state.time = std::filesystem::last_write_time(file, error);
    state.there = !error;
    if (!state.there) {
        return {};
    }
    state.bytes = std::filesystem::file_size(file, error);
    return state;
}

}  // namespace still::command
