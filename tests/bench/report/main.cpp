// bench_report: the tables of tests/bench/run.sh, as markdown, from the JSON of its rounds.

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>

#include "demos/stillframe/formatted.h"
#include "tests/bench/report/samples.h"

namespace still::bench {
namespace {

using command::formatted;

/// Few digits, so that microseconds and hundreds of milliseconds can stand in one column.
std::string number(double value) {
    const int decimals = value >= 99.95 ? 0 : value >= 9.995 ? 1 : value >= 0.0995 ? 2 : 4;
    return formatted("%.*f", decimals, value);
}

/// Best and worst round.
std::string cell(const Figure& figure) {
    if (figure.empty()) {
        return "–";
    }
    const std::string best = number(figure.best()), worst = number(figure.worst());
    return best == worst ? best : best + "–" + worst;
}

std::string ratioText(double ratio) {
    return ratio >= 99.95 ? formatted("**%.0f×**", ratio) : formatted("**%.1f×**", ratio);
}

/// A table that grows row by row; columns of ratios end with their geometric mean.
class Table {
  public:
    explicit Table(std::vector<std::string> heads) : heads_(std::move(heads)) {}

    void beginRow(const std::string& name) { rows_.push_back({name}); }
    void add(const std::string& text) { rows_.back().push_back(text); }
    void add(const Figure& figure) { add(cell(figure)); }
    /// How often `ours` goes into `theirs`.
    void addRatio(const Figure& theirs, const Figure& ours) {
        if (theirs.empty() || ours.empty()) {
            add(std::string("–"));
            return;
        }
        const double ratio = theirs.best() / ours.best();
        Mean& mean = means_[rows_.back().size()];
        mean.log_sum += std::log(ratio);
        ++mean.count;
        add(ratioText(ratio));
    }

    void print() const {
        printRow(heads_);
        std::vector<std::string> rule(heads_.size(), "---:");
        rule[0] = "---";
        printRow(rule);
        for (const auto& row : rows_) {
            printRow(row);
        }
        std::vector<std::string> last(heads_.size());
        last[0] = "*geometric mean*";
        for (const auto& [column, mean] : means_) {
            last[column] = ratioText(std::exp(mean.log_sum / mean.count));
        }
        if (!means_.empty() && rows_.size() > 1) {
            printRow(last);
        }
        std::printf("\n");
    }

  private:
    struct Mean {
        double log_sum = 0;
        int count = 0;
    };
    static void printRow(const std::vector<std::string>& cells) {
        for (const std::string& text : cells) {
            std::printf("| %s ", text.c_str());
        }
        std::printf("|\n");
    }

    std::vector<std::string> heads_;
    std::vector<std::vector<std::string>> rows_;
    std::map<size_t, Mean> means_;
};

/// The three renderers; SwiftShader may be missing.
struct Rounds {
    Samples ours, llvmpipe, swiftshader;
};

constexpr const char* kMoving[] = {"pan", "objects"};

void printGbuffer(const Rounds& rounds) {
    const bool swift = !rounds.swiftshader.empty();
    std::printf("Triangles to the full G-buffer, camera moving:\n\n");
    std::vector<std::string> heads{"scene",      "triangles",
                                   "Stillframe", "llvmpipe",
                                   "ratio",      "llvmpipe, no highlights or normal maps",
                                   "ratio"};
    if (swift) {
        heads.insert(heads.end(), {"SwiftShader", "ratio"});
    }
    Table table(heads);
    for (const std::string& scene : rounds.ours.scenes()) {
        const Case& ours = rounds.ours.at(scene, "pan");
        const Case& peer = rounds.llvmpipe.at(scene, "pan");
        table.beginRow(scene);
        table.add(std::to_string(ours.triangles));
        table.add(ours["gbuffer"]);
        table.add(peer["gbuffer"]);
        table.addRatio(peer["gbuffer"], ours["gbuffer"]);
        table.add(peer["lambert"]);
        table.addRatio(peer["lambert"], ours["gbuffer"]);
        if (swift) {
            const Case& other = rounds.swiftshader.at(scene, "pan");
            table.add(other["gbuffer"]);
            table.addRatio(other["gbuffer"], ours["gbuffer"]);
        }
    }
    table.print();
}

/// `figure` in every motion against the peers'; a frozen frame is taken as a whole, for it has no
/// stages.
void printByMotion(const Rounds& rounds, const std::string& figure) {
    const bool swift = !rounds.swiftshader.empty();
    std::vector<std::string> heads{"scene", "llvmpipe"};
    for (const char* motion : {"pan", "objects", "still", "frozen"}) {
        heads.insert(heads.end(), {motion, "ratio"});
    }
    if (swift) {
        heads.insert(heads.end(), {"SwiftShader", "ratio to pan"});
    }
    Table table(heads);
    for (const std::string& scene : rounds.ours.scenes()) {
        const Figure pan = rounds.llvmpipe.at(scene, "pan")[figure];
        table.beginRow(scene);
        table.add(pan);
        for (const char* motion : {"pan", "objects", "still"}) {
            const Figure ours = rounds.ours.at(scene, motion)[figure];
            table.add(ours);
            const Figure peer = rounds.llvmpipe.at(scene, motion)[figure];
            table.addRatio(peer.empty() ? pan : peer, ours);
        }
        const Figure frozen = rounds.ours.at(scene, "frozen")["total"];
        table.add(frozen);
        table.addRatio(pan, frozen);
        if (swift) {
            const Figure other = rounds.swiftshader.at(scene, "pan")[figure];
            table.add(other);
            table.addRatio(other, rounds.ours.at(scene, "pan")[figure]);
        }
    }
    table.print();
}

Figure peakOf(const Samples& samples, const std::string& scene) {
    Figure peak;
    for (const char* motion : {"still", "pan", "objects"}) {
        const Figure memory = samples.at(scene, motion)["memory"];
        if (!memory.empty()) {
            peak.add(memory.worst());
        }
    }
    return peak;
}

void printMemory(const Rounds& rounds) {
    const bool swift = !rounds.swiftshader.empty();
    std::printf("Peak memory of the whole process, MB:\n\n");
    std::vector<std::string> heads{"scene", "Stillframe", "llvmpipe", "ratio"};
    if (swift) {
        heads.insert(heads.end(), {"SwiftShader", "ratio"});
    }
    Table table(heads);
    for (const std::string& scene : rounds.ours.scenes()) {
        const Figure ours = peakOf(rounds.ours, scene);
        const Figure peer = peakOf(rounds.llvmpipe, scene);
        table.beginRow(scene);
        table.add(ours);
        table.add(peer);
        table.addRatio(peer, ours);
        if (swift) {
            const Figure other = peakOf(rounds.swiftshader, scene);
            table.add(other);
            table.addRatio(other, ours);
        }
    }
    table.print();
}

void printPeer(const char* name, const Samples& samples) {
    std::printf("All times of %s, camera moving:\n\n", name);
    constexpr const char* kStages[] = {"depth", "lambert", "gbuffer", "taa", "output", "total"};
    std::vector<std::string> heads{"scene"};
    heads.insert(heads.end(), std::begin(kStages), std::end(kStages));
    Table table(heads);
    for (const std::string& scene : samples.scenes()) {
        table.beginRow(scene);
        for (const char* stage : kStages) {
            table.add(samples.at(scene, "pan")[stage]);
        }
    }
    table.print();
}

void printOwn(const Samples& samples) {
    std::printf("All times of Stillframe:\n\n");
    constexpr const char* kStages[] = {"transform", "bin",    "visibility", "shade",
                                       "taa",       "output", "total"};
    std::vector<std::string> heads{"scene, motion"};
    heads.insert(heads.end(), std::begin(kStages), std::end(kStages));
    heads.emplace_back("picture");
    Table table(heads);
    for (const std::string& scene : samples.scenes()) {
        for (const char* motion : {"pan", "objects", "still", "frozen"}) {
            const Case& one = samples.at(scene, motion);
            if (one.figures.empty()) {
                continue;
            }
            table.beginRow(scene + ", " + motion);
            for (const char* stage : kStages) {
                table.add(one[stage]);
            }
            table.add("frame " + std::to_string(one.last_frame) + " `" +
                      (one.hashes.size() == 1 ? *one.hashes.begin() : "DIFFERS") + "`");
        }
    }
    table.print();
}

/// Every round has drawn the same bytes, and both have measured something to compare.
bool complete(const Rounds& rounds) {
    for (const std::string& scene : rounds.ours.scenes()) {
        const Case& ours = rounds.ours.at(scene, kMoving[0]);
        if (ours.hashes.size() != 1 || ours["gbuffer"].empty() ||
            rounds.llvmpipe.at(scene, kMoving[0])["gbuffer"].empty()) {
            std::fprintf(stderr, "bench_report: %s: figures are missing, or pictures differ\n",
                         scene.c_str());
            return false;
        }
    }
    return !rounds.ours.empty();
}

void print(const Rounds& rounds, const std::vector<std::string>& notes) {
    for (const std::string& note : notes) {
        std::printf("%s\n", note.c_str());
    }
    std::printf("%s×%s, %s threads; Stillframe with %s, llvmpipe: %s, %s",  //
                rounds.ours.about("width").c_str(), rounds.ours.about("height").c_str(),
                rounds.ours.about("threads").c_str(), rounds.ours.about("simd").c_str(),
                rounds.llvmpipe.about("renderer").c_str(),
                rounds.llvmpipe.about("version").c_str());
    if (!rounds.swiftshader.empty()) {
        std::printf("; SwiftShader: %s", rounds.swiftshader.about("renderer").c_str());
    }
    std::printf(
        ".\nWall milliseconds, medians; the best and the worst round. Ratios are of the best.\n\n");
    printGbuffer(rounds);
    std::printf("TAA (`still`, the default preset), in each motion:\n\n");
    printByMotion(rounds, "taa");
    std::printf("Whole frame, Stillframe's with the encoding to 8 bits, the peers' without:\n\n");
    printByMotion(rounds, "total");
    printMemory(rounds);
    printOwn(rounds.ours);
    printPeer("llvmpipe", rounds.llvmpipe);
    if (!rounds.swiftshader.empty()) {
        printPeer("SwiftShader", rounds.swiftshader);
    }
}

bool readAll(const std::vector<std::string>& files, Samples& out) {
    for (const std::string& file : files) {
        if (const Result<void> read = out.read(file); !read) {
            std::fprintf(stderr, "bench_report: %s\n", read.error().message.c_str());
            return false;
        }
    }
    return true;
}

int run(int argc, char** argv) {
    CLI::App app("Tables from the rounds of tests/bench/run.sh", "bench_report");
    std::vector<std::string> ours, llvmpipe, swiftshader, notes;
    app.add_option("--ours", ours, "JSON of stillframe bench")->required();
    app.add_option("--llvmpipe", llvmpipe, "JSON of bench_peer")->required();
    app.add_option("--swiftshader", swiftshader, "JSON of bench_peer --driver swiftshader");
    app.add_option("--note", notes, "Lines for the top");
    CLI11_PARSE(app, argc, argv);
    Rounds rounds;
    if (!readAll(ours, rounds.ours) || !readAll(llvmpipe, rounds.llvmpipe) ||
        !readAll(swiftshader, rounds.swiftshader)) {
        return 3;
    }
    print(rounds, notes);
    return complete(rounds) ? 0 : 1;
}

}  // namespace
}  // namespace still::bench

int main(int argc, char** argv) {
    return still::bench::run(argc, argv);
}
