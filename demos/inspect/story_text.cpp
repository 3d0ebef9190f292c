#include "demos/inspect/story_text.h"

#include <algorithm>
#include <cstdlib>

#include "demos/stillframe/formatted.h"
#include "postfx/encode.h"

namespace still::inspect {
namespace {

using command::formatted;

double pixels(int fx8) {
    return fx8 / 256.0;
}

double percent(int part, int whole) {
    return 100.0 * part / whole;
}

std::string channels(const StoryColour& c) {
    return formatted("%d %d %d", c[0], c[1], c[2]);
}

const char* nameOf(PixelSource source) {
    switch (source) {
        case PixelSource::none:
            return "nothing was resolved yet";
        case PixelSource::first:
            return "no past: this frame, filtered in space";
        case PixelSource::mean:
            return "at rest: the exact mean of its samples";
        case PixelSource::gathered:
            return "gathered from raw samples of the last frames";
        case PixelSource::blended:
            return "this frame's sample and history, blended";
    }
    return "";
}

/// Writes the lines; working colours are of `tone`.
class Teller {
  public:
    Teller(const PickedStory& story, std::vector<StoryLine>& lines)
        : story_(story), lines_(lines), tone_(story.taa ? story.mode.policy.tone : Tone::linear) {}

    void tell() {
        pixel();
        if (!story_.taa) {
            return;
        }
        owner(story_.taa->owner);
        past(*story_.taa);
        if (story_.taa->source == PixelSource::blended) {
            blend(*story_.taa);
        }
        result(*story_.taa);
    }

  private:
    void heading(std::string text) { lines_.push_back({.heading = true, .text = std::move(text)}); }
    void line(std::string text) { lines_.push_back({.text = std::move(text)}); }
    void linear(std::string text, const StoryColour& c) {
        lines_.push_back({.text = std::move(text), .swatch = shownColour(c, Tone::linear)});
    }
    void working(std::string text, const StoryColour& c) {
        lines_.push_back({.text = std::move(text), .swatch = shownColour(c, tone_)});
    }

    void pixel();
    void owner(const StoryOwner& owner);
    void past(const PixelStory& taa);
    void tap(const PixelTap& tap);
    void blend(const PixelStory& taa);
    void result(const PixelStory& taa);

    const PickedStory& story_;
    std::vector<StoryLine>& lines_;
    Tone tone_;
};

void Teller::pixel() {
    const Rgb8 out = story_.output;
    heading(formatted("Pixel %d, %d: %s", story_.pixel.x, story_.pixel.y,
                      inspect::nameOf(story_.mode).c_str()));
    lines_.push_back({.text = formatted("output #%02x%02x%02x (%d, %d, %d)", out.r, out.g, out.b,
                                        out.r, out.g, out.b),
                      .swatch = out});
    line("surface " + (story_.surface.empty() ? "none: background" : story_.surface));
    if (story_.mode.anti_aliasing == AntiAliasing::ssaa) {
        line(formatted("mean of %d of %d samples", story_.samples, story_.mode.ssaa_samples));
        return;
    }
    line(formatted("sample at %+.3f, %+.3f pixel from the centre", pixels(story_.jitter_x_fx8),
                   pixels(story_.jitter_y_fx8)));
    if (story_.taa) {
        linear("sample, linear fx12: " + channels(story_.taa->raw), story_.taa->raw);
    }
}

void Teller::owner(const StoryOwner& owner) {
    heading("Motion");
    line(formatted("follows surface %d%s%s", owner.surface, owner.moved ? ", which moved" : "",
                   owner.inferred ? ", inferred: no sample of the window shows it" : ""));
    if (owner.motion.x_fx8 == kNoHistory) {
        line("where it was before is not known");
    } else {
        line(formatted("was at %+.2f, %+.2f pixel a frame ago", pixels(owner.motion.x_fx8),
                       pixels(owner.motion.y_fx8)));
    }
    line(formatted("depth %d now, expected before %d (log. steps of 1/2048)", owner.depth,
                   owner.expected));
}

void Teller::tap(const PixelTap& tap) {
    const char* layer = tap.layer == TapLayer::nearer    ? ", nearer"
                        : tap.layer == TapLayer::farther ? ", farther"
                                                         : "";
    const std::string surface = tap.surface < 0 ? "" : formatted(" surface %d", tap.surface);
    const std::string depth = tap.depth < 0 ? "" : formatted(" depth %d", tap.depth);
    linear(formatted("  %d, %d at %+.2f, %+.2f%s%s%s: weight %d, used %d, %s%s", tap.x, tap.y,
                     pixels(tap.from_centre_x_fx8), pixels(tap.from_centre_y_fx8), surface.c_str(),
                     depth.c_str(), layer, tap.weight, tap.used,
                     std::string(verdictName(tap.verdict)).c_str(),
                     tap.recoloured ? ", recoloured" : ""),
           tap.colour);
}

void Teller::past(const PixelStory& taa) {
    heading("Past");
    line(nameOf(taa.source));
    if (taa.layered) {
        line(taa.apart ? "two surfaces in the window, moving apart" : "two surfaces in the window");
    }
    if (taa.lost > 0) {
        line(formatted("lost %.0f %% of the past's weight, most by: %s", percent(taa.lost, 255),
                       std::string(verdictName(taa.reason)).c_str()));
    }
    int age = -1;
    bool far = false;
    for (const PixelTap& each : taa.taps) {
        if (each.along_far != far) {
            far = each.along_far;
            age = -1;
            line("the farther surface, for the colour that it has here now:");
        }
        if (each.age != age) {
            age = each.age;
            line(age == 0 ? std::string("this frame")
                          : formatted("%d frame%s ago", age, age == 1 ? "" : "s"));
        }
        tap(each);
    }
}

void Teller::blend(const PixelStory& taa) {
    const BlendStory& blend = taa.blend;
    heading("Clip and blend");
    working("sample, filtered: " + channels(blend.sample), blend.sample);
    working("history at the pixel's place: " + channels(blend.history), blend.history);
    if (blend.rectifies) {
        const StoryBox& box = taa.box_ycocg;
        line("box Y Co Cg from " + channels(box.low) + " to " + channels(box.high));
        working((blend.clipped ? "history, clipped: " : "history lies inside the box: ") +
                    channels(blend.rectified),
                blend.rectified);
    }
    line(formatted("share of the sample %.1f %%, trust in history %.0f %%",
                   percent(blend.alpha_q15, 32768), percent(blend.trust_q8, 256)));
}

void Teller::result(const PixelStory& taa) {
    heading("Result");
    if (story_.mode.policy.method == Method::gather) {
        line(formatted("%d sample%s in the pixel%s", taa.count, taa.count == 1 ? "" : "s",
                       taa.finished ? ": finished" : ""));
        if (taa.spatial_q8 > 0) {
            line(formatted("spatial filter %.0f %%", percent(taa.spatial_q8, 256)));
        }
    } else {
        line(formatted("confidence %.0f %%", percent(taa.confidence, 255)));
    }
    linear("resolved, linear fx12: " + channels(taa.output), taa.output);
}

}  // namespace

Rgb8 shownColour(const StoryColour& colour, Tone tone) {
    static const OutputTable table;
    StoryColour linear = colour;
    if (tone == Tone::reinhard) {  // c = l / (1 + max l), so l = c / (1 − max c)
        const int64_t brightest = std::max({colour[0], colour[1], colour[2]});
        const int64_t rest = std::max<int64_t>(32768 - brightest, 1);
        for (int& channel : linear) {
            channel = int(std::min<int64_t>(int64_t{channel} * 4096 / rest, 65535));
        }
    }
    const auto encoded = [&](int channel) {
        return table[uint16_t(std::clamp(channel, 0, 65535))];
    };
    return {encoded(linear[0]), encoded(linear[1]), encoded(linear[2])};
}

std::vector<StoryLine> storyLines(const PickedStory& story) {
    std::vector<StoryLine> lines;
    Teller(story, lines).tell();
    return lines;
}

}  // namespace still::inspect
