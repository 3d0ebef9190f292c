#pragma once
// File names with a place for the frame number: shot.{frame}.png, shot.{frame:4}.png,
// shot.%04d.png; and places for the name of the model: {model}.png.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "demos/stillframe/outcome.h"

namespace still::command {

/// A file name, split where the frame number goes.
class NamePattern {
  public:
    /// Refuses a second place for the number, a place in the folder part, and widths over 9.
    static Outcome<NamePattern> parse(const std::string& text);

    bool numbered() const { return numbered_; }
    /// The same with `model` in every place of {model}, also in the folder. A name that holds
    /// places itself keeps them as they are.
    NamePattern withModel(const std::string& model) const;
    /// The same with ".{frame:4}" before the extension, unless it has a place already.
    NamePattern withNumber() const;
    /// The name for `frame`; without a place it is always the same.
    std::filesystem::path at(int frame) const;
    /// The name for `frame` with "PLANE." before the extension, which becomes png.
    std::filesystem::path planeAt(int frame, const std::string& plane) const;
    /// Numbers of the existing files that match, ascending.
    std::vector<int> existing() const;

  private:
    std::optional<int> numberOf(const std::string& file_name) const;

    std::filesystem::path folder_;
    std::string before_, after_;  ///< of the file name
    int digits_ = 1;              ///< at least so many, filled up with zeros
    bool numbered_ = false;
};

}  // namespace still::command
