// A golden folder's manifest, or (if the input does not begin with a brace) a recording.

#include "engine/golden.h"
#include "tests/fuzz/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    using namespace still;
    const std::string_view text = fuzz::textOf({data, size});
    if (!text.starts_with('{')) {
        fuzz::writeScratch("a.hashes", text);
        const Result<golden::Record> record =
            golden::readRecord(fuzz::scratchFolder() / "a.hashes");
        if (record) {
            fuzz::writeScratch("a.hashes", golden::recordText(*record));
            const Result<golden::Record> again =
                golden::readRecord(fuzz::scratchFolder() / "a.hashes");
            fuzz::require(again && *again == *record, "a recording reads back as it was written");
        }
        return 0;
    }
    fuzz::writeScratch("golden.json", text);
    const Result<golden::Manifest> manifest = golden::readManifest(fuzz::scratchFolder());
    if (!manifest) {
        return 0;
    }
    for (const golden::Case& each : manifest->cases) {
        fuzz::require(!each.name.empty() && !each.frames.empty(), "a case has a name and frames");
        const auto folder = golden::recordFile(*manifest, each.name).parent_path();
        fuzz::require(folder == manifest->folder, "recordings stand beside the manifest");
        fuzz::require(each.settings.width >= 1 && each.settings.height >= 1, "a case has pixels");
    }
    const auto part = golden::chosenCases(*manifest, {.only = {}, .shard = 1, .shards = 2});
    fuzz::require(part.has_value() && part->size() == (manifest->cases.size() + 1) / 2,
                  "every second case is in the first of two parts");
    return 0;
}
