// `stillframe render` and the models that it keeps.

#include <catch2/catch.hpp>
#include <filesystem>
#include <string>

#include "tests/cli/shell.h"
#include "tests/support/data_path.h"

namespace still::test {
namespace {

/// A model of a megabyte, with an image and a warning, and a home for it.
class Home {
  public:
    const TempFolder folder;

    Home() {
        folder.write("c.ppm", "P6\n32 32\n255\n" + std::string(32 * 32 * 3, 'c'));
        folder.write("m.mtl", "newmtl a\nmap_Kd c.ppm\nmap_d missing.png\n");
        folder.write("model.obj",
                     "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\n"
                     "usemtl a\nf 1/1 2/2 3/3\n#" +
                         std::string(size_t{1} << 20, 'x') + "\n");
        folder.write("scene.json", R"({"obj": "model.obj"})");
    }
    Ran render(const std::string& arguments, const std::string& cache = "$PWD/cache") const {
        return shell(folder.path(), "XDG_CACHE_HOME=" + cache +
                                        " stillframe render --resolution 48x32 --hash " +
                                        arguments);
    }
    bool exists(const std::string& name) const {
        return std::filesystem::exists(folder.path() / name);
    }
};

}  // namespace

TEST_CASE("scene cache: a kept model gives the same frame and the same warnings", "[cli]") {
    const Home home;
    for (const std::string scene : {"model.obj", "scene.json"}) {
        const Ran plain = home.render(scene + " --no-cache");
        CHECK(plain.code == 0);
        CHECK(plain.err.find("missing.png") != std::string::npos);
        for (int i = 0; i < 2; ++i) {
            const Ran kept = home.render(scene);
            CHECK(kept.code == 0);
            CHECK(kept.out == plain.out);
            CHECK(kept.err == plain.err);
        }
    }
    CHECK(filesIn(home.folder.path() / "cache" / "stillframe").size() == 1);
}

TEST_CASE("scene cache: without it nothing is written", "[cli]") {
    const Home home;
    CHECK(home.render("model.obj --no-cache").code == 0);
    CHECK(!home.exists("cache"));
    CHECK(shell(home.folder.path(),
                "unset HOME XDG_CACHE_HOME; stillframe render model.obj --hash "
                "--resolution 48x32")
              .code == 0);
}

TEST_CASE("scene cache: a folder that cannot be made is not worth a word", "[cli]") {
    const Home home;
    home.folder.write("file", "");
    const Ran plain = home.render("model.obj --no-cache");
    const Ran blocked = home.render("model.obj", "$PWD/file");
    CHECK(blocked.code == 0);
    CHECK(blocked.out == plain.out);
    CHECK(blocked.err == plain.err);
}

TEST_CASE("scene cache: a full disk leaves nothing half-written", "[cli]") {
    const Home home;
    const Ran plain = home.render("model.obj --no-cache");
    // Files of at most 512 or 1024 bytes.
    const Ran full = shell(home.folder.path(),
                           "ulimit -f 1; XDG_CACHE_HOME=$PWD/cache stillframe render model.obj "
                           "--resolution 48x32 --hash");
    CHECK(full.code == 0);
    CHECK(full.out == plain.out);
    CHECK(full.err == plain.err);
    CHECK(filesIn(home.folder.path() / "cache" / "stillframe").empty());
}

TEST_CASE("scene cache: several programs may start at once", "[cli]") {
    const Home home;
    const Ran plain = home.render("model.obj --no-cache");
    const Ran many = shell(home.folder.path(),
                           "for i in 1 2 3 4 5 6; do XDG_CACHE_HOME=$PWD/cache stillframe render "
                           "model.obj --resolution 48x32 --hash > $i.txt 2> $i.err & done; wait");
    CHECK(many.code == 0);
    for (const std::string i : {"1", "2", "3", "4", "5", "6"}) {
        CHECK(contentsOf(home.folder.path() / (i + ".txt")) == plain.out);
        CHECK(contentsOf(home.folder.path() / (i + ".err")) == plain.err);
    }
    CHECK(filesIn(home.folder.path() / "cache" / "stillframe").size() == 1);
}

}  // namespace still::test
