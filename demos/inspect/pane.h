#pragma once
// One of the pictures of a session: a mode at work on the film, and the view of it that is shown.

#include <memory>
#include <optional>
#include <vector>

#include "demos/inspect/film.h"
#include "demos/inspect/look.h"
#include "demos/inspect/probe.h"
#include "demos/inspect/reference.h"

namespace still::inspect {

class Pane {
  public:
    /// `base` holds what is the same for all modes; its camera is the film's. All that is referred
    /// to must outlive the pane, whose history begins with the frame that is rendered first.
    Pane(const Film& film, const FrameSettings& base, const Mode& mode, Workers& workers);

    const Mode& mode() const { return mode_; }
    FrameSettings settings() const;

    /// Frames from the next one on are smaller than the picture by this ratio, in modes that
    /// upscale in time; others stay as they are.
    void setRatio(int ratio_fx8);

    /// Whether finishing the picture takes further frames of a film that stands.
    bool wantsFrames() const { return !reference_ && !at_rest_; }
    /// … or calls of refine().
    bool wantsSamples() const { return reference_ && !reference_->complete(); }
    bool atRest() const { return at_rest_; }
    /// False where render() could not change the picture.
    bool wantsLastFrame() const;
    /// Shows the film's last frame.
    void render();
    /// Of ssaa:N: adds samples to the frame that is shown.
    void refine(int samples);

    ImageView<const Rgb8> picture() const;
    int samples() const { return reference_ ? reference_->samples() : 0; }
    int firstFrame() const { return first_frame_; }
    int shownFrame() const { return shown_frame_; }
    const StageTimes& times() const { return times_; }
    const RasterCounters& counters() const;
    void forgetTimes() { times_ = {}; }
    const FrameResult& result() const { return result_; }

    /// The G-buffer sample that the mode read for the frame shown, with all planes. Of modes that
    /// upscale: drawn at the picture's size.
    const GBuffer& sample();
    ImageView<const uint16_t> overdraw();
    /// Encodes a plane of the story; black where the mode has no past.
    void paintStory(StoryPlane plane, ImageView<Rgb8> out);
    /// See views.h; the picture in grey where the mode has no past.
    void paintRejections(ImageView<Rgb8> out);
    std::optional<PixelStory> story(int x, int y) const {
        return loop_ ? loop_->story(x, y) : std::nullopt;
    }
    /// Of each tile; for ssaa:N all are drawn and resolved until it is complete.
    std::vector<TileWork> tileWork() const;
    /// Where the samples of the mode lie in this frame's pixels, all of its period.
    std::vector<SampleOffset> pattern() const;
    SampleOffset jitter() const { return reference_ ? SampleOffset{} : result_.jitter; }

  private:
    uint32_t sampleNumber() const;
    bool temporal() const { return mode_.anti_aliasing == AntiAliasing::taa; }
    void watchForRest();

    const Film& film_;
    FrameSettings base_;
    Mode mode_;
    Workers& workers_;
    OutputTable table_;
    std::unique_ptr<FrameLoop> loop_;       ///< all modes but ssaa:N
    std::unique_ptr<Reference> reference_;  ///< ssaa:N
    Probe probe_;
    int probed_frame_ = -1;
    struct StoryImages {
        Image<uint16_t> red, green, blue;
        Image<Verdict> reason;
        Image<uint8_t> lost;
    } planes_;  ///< only while a view shows them
    FrameResult result_{};
    StageTimes times_{};
    int first_frame_ = -1, shown_frame_ = -1;
    bool at_rest_ = false;
    int equal_frames_ = 0;  ///< Method::recursive: in a row
    uint64_t last_hash_ = 0;
};

}  // namespace still::inspect
