#pragma once
// What `golden` says: lines for people, JSON for programs, and a page about what differs.

#include <string>
#include <vector>

#include "engine/golden.h"

namespace still::command {

enum class Recorded { made, changed, unchanged };

struct RecordedCase {
    std::string name;
    int frames = 0;
    Recorded what = Recorded::unchanged;
};

struct RecordReport {
    std::vector<RecordedCase> cases;
    std::vector<std::string> removed;  ///< names of cases that are no more
};

std::string recordLines(const RecordReport& report);
/// {"cases": [{"name", "frames", "result": "made"|"changed"|"unchanged"} …], "removed": [NAME …]}
std::string recordJson(const RecordReport& report);

/// One case of a verification; pictures are PNG files, empty where there are none.
struct VerifiedCase {
    golden::CaseVerdict verdict;  ///< its own pictures are given away
    std::string expected_png{}, actual_png{}, diff_png{};
};

struct VerifyReport {
    std::vector<VerifiedCase> cases;
    std::string page;    ///< file; empty when all are equal
    std::string accept;  ///< command; empty when all are equal

    int count(golden::Finding finding) const;
    bool ok() const;
};

/// The cases that are not equal, except those with errors, and a summary.
std::string verifyLines(const VerifyReport& report);
/// {"ok", "cases": [{"name", "result": "equal"|"differs"|"no_golden"|"error", "message", "frames",
/// "differing_frames", and with "differs": "frame", "stage", "tile": [x, y], "rectangle": [x, y,
/// width, height], "tiles", "first_pixel": [x, y], "pixels", "psnr"} …], "report", "accept"}; what
/// is not known is null.
std::string verifyJson(const VerifyReport& report);
/// An HTML page without outside parts.
std::string goldenPage(const VerifyReport& report);

}  // namespace still::command
