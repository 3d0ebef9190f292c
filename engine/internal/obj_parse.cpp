// OBJ statements through tinyobjloader, which is kept away from what it gets wrong:
//  - numbers: its parser uses the C library's pow(), whose last bit depends on the machine, and
//    takes "nan" and other words for 0; here they are parsed by parseNumber();
//  - polygons: LoadObj() keeps a face's size in a byte and triangulates concave faces wrongly;
//    LoadObjWithCallback() hands out whole faces;
//  - mtllib: it stops at the first library of several, and treats backslashes in paths as escapes.

#include "engine/internal/obj_parse.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <istream>
#include <map>
#include <optional>
#include <streambuf>
#include <string_view>
#include <utility>

#include "engine/internal/obj_text.h"

#define TINYOBJLOADER_IMPLEMENTATION
#include <tiny_obj_loader.h>

namespace still {

namespace {

/// Counts warnings of one kind, so that a file with a million of them gives one line.
struct Tally {
    size_t count = 0, first_line = 0;
    void add(size_t line) {
        first_line = count == 0 ? line : first_line;
        ++count;
    }
};

/// Everything known while the file is read, and the stream buffer tinyobjloader reads from: it
/// gets one line at a time (so that the line number is known in its callbacks) and only those it
/// is good at; numbers and library names are taken out on the way.
class ObjSource : public std::streambuf {
  public:
    ObjSource(std::string text, std::string name) : text_(std::move(text)), name_(std::move(name)) {
        normaliseLines(text_);
        // More than most files need, so that nothing is copied; what is not touched costs nothing.
        file.positions.reserve(text_.size() / 32);
        file.texcoords.reserve(text_.size() / 32);
        file.normals.reserve(text_.size() / 32);
        file.corners.reserve(text_.size() / 12);
        file.face_begin.reserve(text_.size() / 24);
        file.face_begin.push_back(0);
    }

    ObjFile file;
    std::optional<Error> error;

    void onFace(const tinyobj::index_t* corners, int count);
    void onMaterial(std::string_view material);
    void onGroup() { new_run_ = true; }
    void finish();

  protected:
    int_type underflow() override;

  private:
    /// Handles the line itself (false) or leaves it to tinyobjloader (true).
    bool passOn(char* begin, std::string_view line);
    void readPosition(std::string_view line);
    void readTexcoord(std::string_view line);
    void readNormal(std::string_view line);
    bool prepareFace(char* begin, char* end);
    int32_t resolve(int index, size_t count) const;
    void startRun();
    void stop(const std::string& what);
    void warn(const Tally& tally, const char* what);

    std::string text_;
    std::string name_;
    size_t next_ = 0;  ///< offset of the next line
    size_t line_ = 0;  ///< number of the current one
    int32_t material_ = kNoIndex;
    bool new_run_ = true;
    std::map<std::string, int32_t, std::less<>> material_numbers_;
    Tally small_faces_, points_and_lines_, bad_texcoords_, bad_normals_, missing_attributes_;
};

ObjSource::int_type ObjSource::underflow() {
    while (next_ < text_.size() && !error) {
        const size_t end = text_.find('\n', next_);
        char* const begin = text_.data() + next_;
        char* const stop = text_.data() + end;
        next_ = end + 1;
        ++line_;
        if (passOn(begin, trimmed({begin, size_t(stop - begin)}))) {
            setg(begin, begin, stop + 1);
            return traits_type::to_int_type(*begin);
        }
    }
    return traits_type::eof();
}

bool ObjSource::passOn(char* begin, std::string_view line) {
    if (startsStatement(line, "v")) {
        readPosition(line.substr(1));
    } else if (startsStatement(line, "vt")) {
        readTexcoord(line.substr(2));
    } else if (startsStatement(line, "vn")) {
        readNormal(line.substr(2));
    } else if (startsStatement(line, "f")) {
        return prepareFace(begin, begin + (line.data() - begin) + line.size());
    } else if (startsStatement(line, "mtllib")) {
        file.libraries.emplace_back(trimmed(line.substr(6)));
    } else if (startsStatement(line, "l") || startsStatement(line, "p")) {
        points_and_lines_.add(line_);
    } else {
        return startsStatement(line, "usemtl") || startsStatement(line, "g") ||
               startsStatement(line, "o");
    }
    return false;
}

void ObjSource::stop(const std::string& what) {
    if (!error) {
        error = Error{name_ + ":" + std::to_string(line_) + ": " + what};
    }
}

void ObjSource::warn(const Tally& tally, const char* what) {
    if (tally.count > 0) {
        file.warnings.push_back(name_ + ":" + std::to_string(tally.first_line) + ": " +
                                std::to_string(tally.count) + " " + what);
    }
}

void ObjSource::readPosition(std::string_view line) {
    const auto vertex = [&] { return "vertex " + std::to_string(file.positions.size() + 1); };
    std::array<float, 3> position;
    for (float& component : position) {
        const std::string_view word = takeWord(line);
        const std::optional<double> number = parseNumber(word);
        if (!number) {
            return stop(vertex() + ": \"" + shownText(word) + "\", expected three numbers");
        }
        if (!(std::abs(*number) <= kMaxObjNumber)) {
            return stop(vertex() + " is not finite (" + shownText(word) +
                        "), expected coordinates within ±1e18");
        }
        component = float(*number);
    }
    file.positions.push_back(position);
}

void ObjSource::readTexcoord(std::string_view line) {
    std::array<float, 2> texcoord{};
    for (float& component : texcoord) {
        const std::string_view word = takeWord(line);
        const double number = word.empty() ? 0.0 : parseNumber(word).value_or(NAN);
        if (!std::isfinite(float(number))) {
            bad_texcoords_.add(line_);
            texcoord = {};
            break;
        }
        component = float(number);
    }
    file.texcoords.push_back(texcoord);
}

void ObjSource::readNormal(std::string_view line) {
    std::array<float, 3> normal{};
    for (float& component : normal) {
        const double number = parseNumber(takeWord(line)).value_or(NAN);
        if (!(std::abs(number) <= kMaxObjNumber)) {
            bad_normals_.add(line_);
            normal = {};
            break;
        }
        component = float(number);
    }
    file.normals.push_back(normal);
}

/// Blanks out a comment behind the corners and refuses numbers that do not fit an int: atoi() is
/// undefined for them.
bool ObjSource::prepareFace(char* begin, char* end) {
    char* const comment = std::find(begin, end, '#');
    std::fill(comment, end, ' ');
    int digits = 0;
    for (const char* c = begin; c != comment; ++c) {
        digits = *c >= '0' && *c <= '9' ? digits + 1 : 0;
        if (digits > 9) {
            stop("face " + std::to_string(file.faceCount() + 1) +
                 ": index of more than 9 digits, expected the number of a vertex");
            return false;
        }
    }
    return true;
}

/// OBJ indices count from 1, or from −1 backwards from the last one read so far.
int32_t ObjSource::resolve(int index, size_t count) const {
    const int64_t i = index < 0 ? int64_t(count) + index : int64_t(index) - 1;
    return index == 0 || i < 0 || i >= int64_t(count) ? kNoIndex : int32_t(i);
}

void ObjSource::onFace(const tinyobj::index_t* corners, int count) {
    if (error) {
        return;
    }
    const size_t begin = file.corners.size();
    for (int i = 0; i < count; ++i) {
        // A vertex that comes later in the file does not exist yet.
        const int32_t position = resolve(corners[i].vertex_index, file.positions.size());
        if (position == kNoIndex) {
            return stop("face " + std::to_string(file.faceCount() + 1) + ": vertex " +
                        std::to_string(corners[i].vertex_index) + " does not exist, " +
                        std::to_string(file.positions.size()) + " are defined so far");
        }
        const int32_t texcoord = resolve(corners[i].texcoord_index, file.texcoords.size());
        const int32_t normal = resolve(corners[i].normal_index, file.normals.size());
        if ((texcoord == kNoIndex && corners[i].texcoord_index != 0) ||
            (normal == kNoIndex && corners[i].normal_index != 0)) {
            missing_attributes_.add(line_);
        }
        file.corners.push_back({position, texcoord, normal});
    }
    if (count < 3) {
        file.corners.resize(begin);
        return small_faces_.add(line_);
    }
    startRun();
    file.face_begin.push_back(uint32_t(file.corners.size()));
}

void ObjSource::startRun() {
    if (new_run_ || file.runs.back().material != material_) {
        file.runs.push_back({uint32_t(file.faceCount()), material_});
        new_run_ = false;
    }
}

void ObjSource::onMaterial(std::string_view material) {
    const std::string key(trimmed(material));
    const auto [entry, added] = material_numbers_.try_emplace(key, int32_t(file.materials.size()));
    if (added) {
        file.materials.push_back(key);
    }
    material_ = entry->second;
}

void ObjSource::finish() {
    warn(small_faces_, "faces with fewer than three corners are ignored");
    warn(points_and_lines_, "point or line statements are ignored");
    warn(bad_texcoords_, "texture coordinates are not finite numbers and become 0");
    warn(bad_normals_, "normals are not finite numbers and are generated");
    warn(missing_attributes_, "face corners use texture coordinates or normals that do not exist");
}

tinyobj::callback_t callbacks() {
    tinyobj::callback_t calls;
    calls.index_cb = [](void* user, tinyobj::index_t* corners, int count) {
        static_cast<ObjSource*>(user)->onFace(corners, count);
    };
    calls.usemtl_cb = [](void* user, const char* name, int) {
        static_cast<ObjSource*>(user)->onMaterial(name);
    };
    calls.group_cb = [](void* user, const char**, int) {
        static_cast<ObjSource*>(user)->onGroup();
    };
    calls.object_cb = [](void* user, const char*) { static_cast<ObjSource*>(user)->onGroup(); };
    return calls;
}

}  // namespace

Result<ObjFile> parseObj(std::string text, const std::string& name) {
    ObjSource source(std::move(text), name);
    std::istream stream(&source);
    // It has nothing to report: libraries and materials never reach it.
    tinyobj::LoadObjWithCallback(stream, callbacks(), &source);
    if (source.error) {
        return tl::make_unexpected(*source.error);
    }
    source.finish();
    return std::move(source.file);
}

}  // namespace still
