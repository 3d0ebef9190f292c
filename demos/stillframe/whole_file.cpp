#include "demos/stillframe/whole_file.h"

#include "demos/stillframe/file_cache.h"
#include "demos/stillframe/output_file.h"

namespace still::command {

Outcome<void> writeWholeFiles(const std::vector<WholeFile>& files, Interruption& interruption) {
    std::vector<OutputFile> outputs;
    outputs.reserve(files.size());
    for (const WholeFile& file : files) {
        auto output = OutputFile::create(file.path, interruption);
        if (!output) {
            return tl::make_unexpected(output.error());
        }
        const size_t written =
            std::fwrite(file.bytes.data(), 1, file.bytes.size(), output->stream());
        if (written != file.bytes.size() || std::fflush(output->stream()) != 0) {
            return fileError(systemMessage(file.path, "cannot write"));
        }
        outputs.push_back(std::move(*output));
    }
    for (OutputFile& output : outputs) {
        if (auto committed = output.commit(); !committed) {
            return committed;
        }
    }
    return {};
}

Outcome<void> tryFolder(const std::filesystem::path& folder, Interruption& interruption) {
    return makeFolder(folder).and_then([&] {
        return OutputFile::create(folder / "index.html", interruption).map([](const OutputFile&) {
        });
    });
}

}  // namespace still::command
