#pragma once
// How far two pictures are apart, or two sequences: squared error, PSNR, largest difference, SSIM,
// sharpness, flicker, ghosts, recovery, residues, trails. Exact or in a written order, so the
// numbers are the same on every machine. FLIP is in postfx/flip.h.

#include <cstdint>
#include <span>
#include <vector>

#include "rasterizer/gbuffer.h"
#include "rasterizer/image.h"

namespace still {

/// Error over the 8-bit channels of two pictures. Whole numbers, so errors of several frames add up
/// exactly.
struct PixelError {
    uint64_t squared_sum = 0;  ///< Σ (a − b)² over all channels
    uint64_t channels = 0;     ///< 3 · pixels
    int max_difference = 0;    ///< largest |a − b| of any channel, 0 … 255

    bool identical() const { return max_difference == 0; }
    PixelError& operator+=(const PixelError& other);
};

/// The views have equal sizes.
PixelError pixelError(ImageView<const Rgb8> a, ImageView<const Rgb8> b);

/// Peak signal-to-noise ratio in dB for a peak of 255; infinite when identical.
double psnrDb(const PixelError& error);

/// Root of the mean squared error, in 8-bit codes; 0 for no pixels.
double rmse(const PixelError& error);

/// Mean structural similarity of the luma (BT.601 weights), 1 when identical. Windows of 11 × 11
/// with a Gaussian of σ = 1.5 that lie fully inside (Wang, Bovik, Sheikh, Simoncelli: "Image
/// quality assessment: from error visibility to structural similarity", 2004); a picture narrower
/// or lower than a window shortens the window to its own size. The views have equal sizes, not 0.
double ssim(ImageView<const Rgb8> a, ImageView<const Rgb8> b);

/// Gradient energy of the test over that of the reference: Σ over pixels of the squared luma
/// differences to the right and lower neighbours (BT.601 weights). 1 = as sharp, less = blurred,
/// more = aliased or sharpened. When the reference is flat: 1 if the test is flat, too, else
/// infinite. The views have equal sizes.
double sharpnessRatio(ImageView<const Rgb8> reference, ImageView<const Rgb8> test);

/// Root mean square, over pixels, channels and frames, of how much the error (output − reference)
/// changes from one frame to the next; 1 = the whole range from black to white. What moves in the
/// reference alone does not count.
class FlickerMeter {
  public:
    /// Frames in order; all of the size of the first one since the last cut.
    void add(ImageView<const Rgb8> reference, ImageView<const Rgb8> output);
    /// The next frame is not compared with the one before.
    void cut() { before_.clear(); }
    /// 0 when no two frames were compared.
    double rms() const;

  private:
    std::vector<int16_t> before_;  ///< errors of the last frame, channel by channel
    uint64_t squared_sum_ = 0;
    uint64_t channels_ = 0;
};

/// Frames for which a revealed place counts as new.
constexpr int kRevealFrames = 8;

/// Finds where a surface has just appeared because another one vanished or moved away: there, and
/// only there, history shows something else and may leave a ghost. A pixel is revealed when the
/// surface it shows was not the one seen at pixel + motion (rounded to a pixel) a frame ago. It
/// stays marked for kRevealFrames frames, the mark moves with its surface. Not marked are
///   what comes in from outside of the picture: nothing was there that could stay;
///   pixels with another surface among their 8 neighbours: silhouettes, whose anti-aliasing has
///   errors of its own.
class RevealMask {
  public:
    /// G-buffers of consecutive frames with their samples at the pixels' centres, with the motion
    /// plane. `cut`: nothing is known of before. A changed size is a cut. Returns 1 where marked;
    /// valid until the next call.
    ImageView<const uint8_t> next(const GBuffer& gbuffer, bool cut);

  private:
    Image<uint16_t> id_before_;
    Image<uint8_t> left_, left_before_;  ///< frames that a mark still lives
    Image<uint8_t> mask_;
};

/// Errors above this, of any channel, are ghosts where something was revealed. 8-bit codes.
constexpr int kGhostError = 8;

/// Pixels where mask ≠ 0 and any channel is off by more than kGhostError. Equal sizes.
uint64_t ghostPixels(ImageView<const Rgb8> output, ImageView<const Rgb8> reference,
                     ImageView<const uint8_t> mask);

/// How many frames after an event the picture is still disturbed: the smallest n such that from
/// rmse_after[n] on all errors stay within 10 % above `settled_rmse`, or under a quarter of a code.
/// rmse_after[0] belongs to the frame of the event, so 0 means that it left no trace, 1 that it was
/// cured one frame later; all of them when the error never settles. Units: rmse(), 8-bit codes.
int recoveryFrames(std::span<const double> rmse_after, double settled_rmse);

/// How much of the picture `before` an event is still seen in `picture` though it should look like
/// `after`: the share s for which after + s · (before − after) comes nearest to it, least squares
/// over all channels, so that errors of other kinds cancel. 0 when the event changed nothing. The
/// views have equal sizes.
double residualShare(ImageView<const Rgb8> picture, ImageView<const Rgb8> before,
                     ImageView<const Rgb8> after);

/// Mean of pictures of the same frame with different random numbers: noise fades, what a method
/// gets wrong every time stays.
class PictureMean {
  public:
    /// All of the first one's size.
    void add(ImageView<const Rgb8> picture);
    /// Of one channel (0 … 2), 8-bit codes. After at least one add().
    double at(int x, int y, int channel) const;

  private:
    int width_ = 0;
    std::vector<uint32_t> sums_;  ///< channel by channel
    uint32_t pictures_ = 0;
};

/// A channel that was so far away from what it is now was passed by something, codes …
constexpr int kTrailPassed = 24;
/// … and what passed it is gone when it is now as near as this to the reference before.
constexpr int kTrailGone = 2;

/// What things that passed leave behind under a camera that stands: the most, in 8-bit codes, by
/// which a channel is off towards what it was, wherever something has passed and is gone.
/// `references` show the scene at some instants in order, the last one that of `mean`; 0 when they
/// are fewer than three.
double trailCodes(std::span<const ImageView<const Rgb8>> references, const PictureMean& mean);

}  // namespace still
