// Words between spaces, in a fixed order; a picture is its number of bytes, a space, and the bytes.

#include "demos/stillframe/cell_store.h"

#include <charconv>
#include <cstdio>
#include <string_view>

namespace still::command {
namespace {

constexpr std::string_view kNothing = "-";

class Writer {
  public:
    void put(int value) { bytes_ += std::to_string(value) + " "; }
    void put(double value) {
        char word[40];
        std::snprintf(word, sizeof word, "%.17g ", value);
        bytes_ += word;
    }
    void put(const std::optional<double>& value) {
        if (value) {
            put(*value);
        } else {
            bytes_ += std::string(kNothing) + " ";
        }
    }
    void putBytes(const std::string& bytes) {
        put(int(bytes.size()));
        bytes_ += bytes;
    }
    std::string take() { return std::move(bytes_); }

  private:
    std::string bytes_;
};

/// After the first word that does not fit, everything read is empty and ok() is false.
class Reader {
  public:
    explicit Reader(std::string_view rest) : rest_(rest) {}
    bool ok() const { return ok_; }
    bool atEnd() const { return rest_.empty(); }

    template <class Number>
    void get(Number& value) {
        parse(word(), value);
    }
    void get(std::optional<double>& value) {
        const std::string_view text = word();
        if (text != kNothing) {
            parse(text, value.emplace());
        }
    }
    void getBytes(std::string& bytes) {
        int size = 0;
        get(size);
        ok_ = ok_ && size >= 0 && size_t(size) <= rest_.size();
        if (ok_) {
            bytes = rest_.substr(0, size_t(size));
            rest_.remove_prefix(size_t(size));
        }
    }

  private:
    std::string_view word() {
        const size_t end = rest_.find(' ');
        ok_ = ok_ && end != std::string_view::npos;
        if (!ok_) {
            return {};
        }
        const std::string_view text = rest_.substr(0, end);
        rest_.remove_prefix(end + 1);
        return text;
    }
    template <class Number>
    void parse(std::string_view text, Number& value) {
        const char* end = text.data() + text.size();
        const auto [stop, error] = std::from_chars(text.data(), end, value);
        ok_ = ok_ && error == std::errc() && stop == end;
    }

    std::string_view rest_;
    bool ok_ = true;
};

/// Writes or reads the measures, in one order for both.
template <class Stream, class Measures, class Visit>
void visitMeasures(Stream& stream, Measures& m, Visit&& visit) {
    visit(stream, m.psnr);
    visit(stream, m.ssim);
    visit(stream, m.flip);
    visit(stream, m.flicker);
    visit(stream, m.ghost_area);
    visit(stream, m.recovery_frames);
    visit(stream, m.sharpness);
    visit(stream, m.residual);
    visit(stream, m.trail);
    visit(stream, m.ms);
    visit(stream, m.crop_frame);
    visit(stream, m.crop_x);
    visit(stream, m.crop_y);
}

constexpr auto kPut = [](Writer& writer, const auto& value) { writer.put(value); };
constexpr auto kGet = [](Reader& reader, auto& value) { reader.get(value); };

}  // namespace

std::string cellBytes(const std::vector<SegmentMeasures>& segments) {
    Writer writer;
    for (const SegmentMeasures& segment : segments) {
        visitMeasures(writer, segment, kPut);
        writer.put(int(segment.frames.size()));
        for (const FrameError& frame : segment.frames) {
            writer.put(frame.frame);
            writer.put(frame.rms);
            writer.put(frame.ssim);
            writer.put(frame.flip);
        }
        writer.putBytes(segment.crop_png);
    }
    return writer.take();
}

std::optional<std::vector<SegmentMeasures>> cellFromBytes(const std::string& bytes) {
    Reader reader(bytes);
    std::vector<SegmentMeasures> segments;
    while (reader.ok() && !reader.atEnd()) {
        SegmentMeasures& segment = segments.emplace_back();
        visitMeasures(reader, segment, kGet);
        int frames = 0;
        reader.get(frames);
        for (int i = 0; reader.ok() && i < frames; ++i) {
            FrameError& frame = segment.frames.emplace_back();
            reader.get(frame.frame);
            reader.get(frame.rms);
            reader.get(frame.ssim);
            reader.get(frame.flip);
        }
        reader.getBytes(segment.crop_png);
    }
    return reader.ok() ? std::optional(std::move(segments)) : std::nullopt;
}

std::string timesBytes(const std::vector<SegmentTimes>& segments) {
    Writer writer;
    for (const SegmentTimes& segment : segments) {
        writer.put(segment ? int(segment->size()) : 0);
        for (size_t i = 0; segment && i < segment->size(); ++i) {
            writer.put((*segment)[i].ms);
            writer.put((*segment)[i].share);
        }
    }
    return writer.take();
}

std::optional<std::vector<SegmentTimes>> timesFromBytes(const std::string& bytes) {
    Reader reader(bytes);
    std::vector<SegmentTimes> segments;
    while (reader.ok() && !reader.atEnd()) {
        SegmentTimes& segment = segments.emplace_back();
        int modes = 0;
        reader.get(modes);
        for (int i = 0; reader.ok() && i < modes; ++i) {
            RaceTime& time = (segment ? *segment : segment.emplace()).emplace_back();
            reader.get(time.ms);
            reader.get(time.share);
        }
    }
    return reader.ok() ? std::optional(std::move(segments)) : std::nullopt;
}

}  // namespace still::command
