// The viewer without a window: events in, pixels out.

#include "demos/viewer/viewer.h"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "demos/scenes/builtin.h"
#include "demos/stillframe/scene_source.h"
#include "demos/viewer/script.h"
#include "tests/support/data_path.h"

namespace still::viewer {
namespace {

namespace fs = std::filesystem;

constexpr double kFrame_s = 1.0 / 60;

const std::string kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
const std::string kTwoTriangles = kTriangle + "v 1 1 0\nf 2 4 3\n";

/// A viewer and the hand that plays it. There is one at a time.
class Played {
  public:
    explicit Played(const std::string& scene, int width = 200, int height = 120)
        : viewer_(*command::openScene(scene), scene, settings(width, height), workers_) {}

    void play(const std::string& script) {
        const auto steps = parseScript(script, "test");
        REQUIRE(steps.has_value());
        for (const ScriptStep& step : *steps) {
            for (std::vector<SDL_Event>& events : player_.eventsOf(step)) {
                for (SDL_Event& event : events) {
                    viewer_.handle(event);
                    if (event.type == SDL_DROPFILE) {
                        SDL_free(event.drop.file);
                    }
                }
                viewer_.draw(kFrame_s);
            }
        }
    }
    /// Long enough for a changed file to be seen and read.
    void waitForFiles() { play("wait 60"); }

    std::vector<uint8_t> bytes(bool panels = true) const {
        const Image<Rgb8> image = viewer_.screenshot(panels);
        std::vector<uint8_t> all;
        for (int y = 0; y < image.height(); ++y) {
            for (int x = 0; x < image.width(); ++x) {
                const Rgb8 pixel = image.at(x, y);
                all.insert(all.end(), {pixel.r, pixel.g, pixel.b});
            }
        }
        return all;
    }
    uint64_t triangles() { return session().scene().triangleCount(); }
    inspect::Session& session() { return viewer_.desk().session; }
    Desk& desk() { return viewer_.desk(); }
    Viewer& viewer() { return viewer_; }

  private:
    static ViewerSettings settings(int width, int height) {
        ViewerSettings settings;
        settings.size = {width, height};
        settings.keeps_fps = false;
        return settings;
    }
    Workers workers_{2};
    Viewer viewer_;
    ScriptPlayer player_;
};

}  // namespace

TEST_CASE("viewer: a script leads to the same pixels, panels too, at every time") {
    const std::string script =
        "wait 3\nmouse drag 60 60 90 50\nkey s\nkey v\nkey g\nkey p\nkey i\nkey h\nwait 2\nkey h\n"
        "mouse click 50 90\nkey m\nmouse move 70 80\nwait 3\nkey space\nwait 4\n";
    std::vector<uint8_t> first;
    {
        Played played("builtin:cubes");
        played.play(script);
        first = played.bytes();
        CHECK(first != played.bytes(false));
    }
    Played again("builtin:cubes");
    again.play(script);
    CHECK(again.bytes() == first);
}

TEST_CASE("viewer: keys do what the help says") {
    Played played("builtin:cubes");
    played.play("wait 1\nkey s\nkey g\nkey x\nkey e\nkey t\nkey r");
    const inspect::Look& look = played.session().look();
    CHECK(look.split);
    CHECK((look.overlays.grid && look.overlays.axes && look.overlays.edges && look.overlays.tiles &&
           look.overlays.arrows));
    played.play("mouse move 10 60\nkey a\nmouse move 190 60\nkey a\nkey shift+v");
    CHECK(inspect::nameOf(played.session().pane(0).mode) == "fast");
    CHECK(inspect::nameOf(played.session().pane(1).mode) == "fxaa");
    CHECK(played.session().pane(1).view == inspect::allViews().back().view);
    played.play("key m\nkey m\nkey m");
    CHECK((look.magnifier.on && look.magnifier.factor == 16));
    CHECK(look.magnifier.x == 190);
    played.play("key m\nmouse drag 100 60 40 60");
    CHECK_FALSE(look.magnifier.on);
    CHECK(look.divider == Approx(0.2));
    played.play("key .\nkey .\nkey ,");
    CHECK(played.session().sceneFrame() == 1);
    played.play("key ctrl+q");
    CHECK(played.viewer().takeRequests().quit);
    CHECK_FALSE(played.viewer().takeRequests().quit);
}

TEST_CASE("viewer: the help says in both columns what a key does") {
    Played played("builtin:triangle", 960, 540);
    played.play("wait 1\nkey h\nwait 2");
    const Image<Rgb8> picture = played.viewer().screenshot(true);
    // Keys are yellow, what they do is white.
    const auto whiteIn = [&](int x0, int x1) {
        int count = 0;
        for (int y = 165; y < 480; ++y) {
            for (int x = x0; x < x1; ++x) {
                const Rgb8 pixel = picture.at(x, y);
                count += pixel.r > 240 && pixel.g > 240 && pixel.b > 240 ? 1 : 0;
            }
        }
        return count;
    };
    CHECK(whiteIn(140, 470) > 1000);
    CHECK(whiteIn(565, 890) > 1000);
}

TEST_CASE("viewer: 5 changes to a parallel projection and back") {
    Played played("builtin:cubes");
    played.play("wait 2\nkey 5\nwait 2");
    const inspect::Rig parallel = played.session().rig();
    CHECK(parallel.pose().orthographic);
    played.play("key 5\nwait 2");
    CHECK_FALSE(played.session().rig().pose().orthographic);
}

TEST_CASE("viewer: the hand orbits, pans, flies and picks; Enter brings the camera back") {
    Played played("builtin:cubes");
    played.play("wait 1");
    const CameraPose begin = played.session().rig().pose();
    const auto pose = [&] { return played.session().rig().pose(); };
    played.play("mouse drag 100 60 140 60");
    CHECK(pose().target == begin.target);
    CHECK(pose().eye != begin.eye);
    played.play("keydown shift\nmouse drag 100 60 140 60\nkeyup shift");
    CHECK(pose().target != begin.target);
    played.play("key enter\nwait 1");
    CHECK(pose().eye == begin.eye);
    CHECK(pose().target == begin.target);
    played.play("mouse down right\nkeydown w\nwait 10\nkeyup w\nmouse up right");
    CHECK(pose().eye != begin.eye);
    const CameraPose flown = pose();
    played.play("key w\nwait 5");  // not while the button is up
    CHECK(pose().eye == flown.eye);
    CHECK_FALSE(played.session().look().picked.has_value());
    played.play("mouse click 100 70");
    REQUIRE(played.session().look().picked.has_value());
    CHECK(played.session().look().picked->x == 100);
    CHECK(played.desk().shown.story);
    played.play("key esc");
    CHECK_FALSE(played.session().look().picked.has_value());
}

TEST_CASE("viewer: a changed file is read again, a broken one leaves the scene and says why") {
    const TempFolder folder;
    const std::string file = folder.write("model.obj", kTriangle).string();
    Played played(file);
    played.play("wait 2\nmouse drag 60 60 90 50");
    const glm::dvec3 eye = played.session().rig().pose().eye;
    folder.write("model.obj", kTwoTriangles);
    played.waitForFiles();
    CHECK(played.triangles() == 2);
    CHECK(played.session().rig().pose().eye == eye);

    folder.write("model.obj", "v 0 0\nf 1 2 9\n");
    played.waitForFiles();
    CHECK(played.triangles() == 2);
    CHECK(played.desk().message_is_error);
    CHECK(isOneLineAbout(played.desk().message, "model.obj"));

    folder.write("model.obj", kTriangle + "mtllib new.mtl\n");
    played.waitForFiles();
    CHECK(played.triangles() == 1);
    CHECK(played.desk().message_is_error);  // the library is missing, and when it comes
    folder.write("new.mtl", "newmtl a\n");
    played.waitForFiles();
    CHECK_FALSE(played.desk().message_is_error);
}

TEST_CASE("viewer: files are dropped, and turned over with the arrows") {
    const TempFolder folder;
    const std::string a = folder.write("a b.obj", kTriangle).string();
    const std::string c = folder.write("c.obj", kTwoTriangles).string();
    folder.write("b.txt", "no scene");
    Played played("builtin:cubes");
    played.play("wait 1\ndrop " + a);
    CHECK(played.desk().scene_name == a);
    CHECK(played.triangles() == 1);
    played.play("key right");
    CHECK(played.desk().scene_name == c);
    played.play("key right");
    CHECK(played.desk().scene_name == a);
    played.play("key left");
    CHECK(played.desk().scene_name == c);
    played.play("drop " + (folder.path() / "none.obj").string());
    CHECK(played.desk().message_is_error);
    CHECK(played.desk().scene_name == c);
    CHECK(played.triangles() == 2);
}

TEST_CASE("viewer: the picture has the size of the window") {
    Played played("builtin:cubes");
    for (const auto& [width, height] : {std::pair{320, 90}, {31, 200}, {1, 1}, {64, 64}}) {
        played.play("resize " + std::to_string(width) + "x" + std::to_string(height) + "\nwait 1");
        CHECK(played.viewer().canvas().width == width);
        CHECK(played.viewer().canvas().height == height);
    }
}

TEST_CASE("viewer: neighbours are the scene files of a folder, by name") {
    const TempFolder folder;
    for (const char* name : {"b.OBJ", "a.json", "c.mtl", "d.obj"}) {
        folder.write(name, "");
    }
    fs::create_directory(folder.path() / "e.obj");
    const auto path = [&](const char* name) { return (folder.path() / name).string(); };
    CHECK(neighboursOf(path("b.OBJ")) ==
          std::vector<std::string>{path("a.json"), path("b.OBJ"), path("d.obj")});
    CHECK(neighboursOf(path("gone.obj")).back() == path("gone.obj"));
    CHECK(neighboursOf("builtin:courtyard").front() == "builtin:courtyard");
}

TEST_CASE("viewer: a change is reported once, when the file has come to rest") {
    const TempFolder folder;
    FileWatch watch;
    const std::string file = folder.write("a.txt", "1").string();
    const std::string later = (folder.path() / "later.txt").string();
    watch.watch({file, later});
    CHECK_FALSE(watch.poll());
    folder.write("a.txt", "22");
    CHECK_FALSE(watch.poll());  // it may still be written
    CHECK(watch.poll());
    CHECK_FALSE(watch.poll());
    folder.write("later.txt", "");
    CHECK_FALSE(watch.poll());
    CHECK(watch.poll());
    fs::remove(file);
    watch.poll();
    CHECK(watch.poll());
}

}  // namespace still::viewer
