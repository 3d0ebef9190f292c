#pragma once
// stillframe golden: regression tests of pictures, on engine/golden.h.

#include <string>

#include "demos/stillframe/interruption.h"
#include "demos/stillframe/limits.h"
#include "demos/stillframe/outcome.h"

namespace still::command {

struct GoldenOptions {
    std::string folder;  ///< with golden.json
    std::string output;  ///< of verify's report; empty: FOLDER/out
    std::string only;    ///< names of cases with commas; empty: all
    std::string shard;   ///< "I/N"; empty: all
    int threads = 0;     ///< 0: all cores
    std::string simd;    ///< empty: the best
    bool json = false;
    bool quiet = false;
    Limits limits;
};

/// Renders the cases and writes NAME.hashes and NAME.FRAME.png into the folder; files that are
/// right already stay as they are. Takes away what it wrote for frames and cases that are no more.
Outcome<ExitCode> goldenRecord(const GoldenOptions& options, Interruption& interruption);

/// Renders the cases and compares them with what was recorded. Pictures and a page about those that
/// differ go to the output folder. ExitCode::differs, or file_error when a case cannot be rendered.
Outcome<ExitCode> goldenVerify(const GoldenOptions& options, Interruption& interruption);

}  // namespace still::command
