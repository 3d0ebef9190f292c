// Recordings as text: "stillframe golden 1", "size WIDTHxHEIGHT", then a line for each stage of
// each frame, "FRAME STAGE HASH TILES", TILES being eight hexadecimal digits each.

#include <algorithm>
#include <charconv>

#include "engine/golden.h"
#include "engine/hash.h"
#include "engine/internal/obj_text.h"

namespace still::golden {
namespace {

constexpr std::string_view kHeader = "stillframe golden 1";
constexpr size_t kTileDigits = 8;

template <class T>
std::optional<T> numberFrom(std::string_view text, int base) {
    T value = 0;
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value, base);
    return error == std::errc() && stop == end && !text.starts_with('-') ? std::optional(value)
                                                                         : std::nullopt;
}

/// Takes the lines in order; the first that does not fit stays in `error`.
class RecordReader {
  public:
    RecordReader(std::string_view text, std::string file) : text_(text), file_(std::move(file)) {}
    Result<Record> read();

  private:
    bool nextLine();
    bool readSize();
    bool isNext(Stage stage) const;
    bool readStage(int stage);
    bool refuse(std::string_view expected);

    std::string_view text_, line_;
    std::string file_;
    int number_ = 0;
    std::string error_;
    Record record_;
    size_t frame_tiles_ = 0;  ///< of planes before Stage::linear, which may be smaller
};

bool RecordReader::refuse(std::string_view expected) {
    error_ = file_ + ":" + std::to_string(number_) + ": expected " + std::string(expected) +
             ", found \"" + shownText(line_) + "\"";
    return false;
}

bool RecordReader::nextLine() {
    ++number_;
    const size_t end = text_.find('\n');
    line_ = text_.substr(0, end);
    text_.remove_prefix(end == std::string_view::npos ? text_.size() : end + 1);
    if (line_.ends_with('\r')) {
        line_.remove_suffix(1);  // as some version-control programs check files out
    }
    return true;
}

bool RecordReader::readSize() {
    std::string_view rest = line_;
    const bool size = takeWord(rest) == "size";
    const std::string_view value = takeWord(rest);
    const size_t x = value.find('x');
    const auto width = numberFrom<int>(value.substr(0, x), 10);
    const auto height = numberFrom<int>(value.substr(x == value.npos ? value.size() : x + 1), 10);
    const auto fits = [](std::optional<int> side) {
        return side && *side >= 1 && *side <= kMaxTargetSize;
    };
    if (!size || !fits(width) || !fits(height) || !rest.empty()) {
        return refuse("size WIDTHxHEIGHT");
    }
    record_.width = *width;
    record_.height = *height;
    return true;
}

/// Whether the next line is one of this stage.
bool RecordReader::isNext(Stage stage) const {
    std::string_view line = text_.substr(0, text_.find('\n'));
    takeWord(line);
    return takeWord(line) == name(stage);
}

bool RecordReader::readStage(int stage) {
    std::string_view rest = line_;
    const auto frame = numberFrom<int>(takeWord(rest), 10);
    const std::string_view stage_name = takeWord(rest);
    const auto whole = numberFrom<uint64_t>(takeWord(rest), 16);
    const std::string_view tiles = takeWord(rest);
    const auto along = [](int pixels) { return size_t(pixels + kTileSize - 1) / kTileSize; };
    const size_t most = along(record_.width) * along(record_.height);
    if (stage == 0) {
        const bool later =
            record_.frames.empty() || (frame && *frame > record_.frames.back().frame);
        if (!frame || !later) {
            return refuse("a frame after the one before");
        }
        record_.frames.push_back({*frame, {}});
    }
    if (frame_tiles_ == 0) {
        frame_tiles_ = std::clamp(tiles.size() / kTileDigits, size_t{1}, most);
    }
    const size_t tile_count = Stage(stage) < Stage::linear ? frame_tiles_ : most;
    Record::Frame& to = record_.frames.back();
    if (!frame || *frame != to.frame || stage_name != name(Stage(stage)) || !whole ||
        !rest.empty() || tiles.size() != kTileDigits * tile_count) {
        return refuse("frame " + std::to_string(to.frame) + ", " + name(Stage(stage)) +
                      ", a hash and hashes of " + std::to_string(tile_count) + " tiles");
    }
    StageHash& hash = to.stages[size_t(stage)];
    hash.whole = *whole;
    for (size_t k = 0; k < tiles.size(); k += kTileDigits) {
        const auto tile = numberFrom<uint32_t>(tiles.substr(k, kTileDigits), 16);
        if (!tile) {
            return refuse("hexadecimal digits");
        }
        hash.tiles.push_back(*tile);
    }
    return true;
}

Result<Record> RecordReader::read() {
    bool good = nextLine() && (line_ == kHeader || refuse(kHeader));
    good = good && nextLine() && readSize();
    while (good && (!text_.empty() || record_.frames.empty())) {
        for (int stage = 0; good && stage < kStages; ++stage) {
            if (!isOfSampledLight(Stage(stage)) || isNext(Stage(stage))) {
                good = nextLine() && readStage(stage);
            }
        }
    }
    if (!good) {
        return fail(error_);
    }
    return std::move(record_);
}

}  // namespace

std::string recordText(const Record& record) {
    std::string text = std::string(kHeader) + "\nsize " + std::to_string(record.width) + "x" +
                       std::to_string(record.height) + "\n";
    for (const Record::Frame& frame : record.frames) {
        for (int stage = 0; stage < kStages; ++stage) {
            const StageHash& hash = frame.stages[size_t(stage)];
            if (isOfSampledLight(Stage(stage)) && hash.tiles.empty()) {
                continue;
            }
            text += std::to_string(frame.frame) + " " + name(Stage(stage)) + " " + hex(hash.whole) +
                    " ";
            for (const uint32_t tile : hash.tiles) {
                text += hex(tile).substr(16 - kTileDigits);
            }
            text += "\n";
        }
    }
    return text;
}

Result<Record> readRecord(const std::filesystem::path& file) {
    return readFile(file).and_then(
        [&](const std::string& text) { return RecordReader(text, shownPath(file)).read(); });
}

}  // namespace still::golden
