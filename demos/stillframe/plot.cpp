#include "demos/stillframe/plot.h"

#include <cairo-svg.h>
#include <cairo.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>

#include "demos/stillframe/label_layout.h"

namespace still::command {
namespace {

constexpr double kPanelWidth = 560, kPanelHeight = 400;
constexpr double kTitleHeight = 48, kFootHeight = 30;
constexpr double kLeft = 62, kRight = 12, kTop = 34, kBottom = 44;  ///< around a panel's area
constexpr double kLabelSize = 12;
constexpr double kMarkerRadius = 4.5;
constexpr double kFrontWidth = 1.5;
constexpr const char* kFont = "DejaVu Sans";

struct Colour {
    double r, g, b;
};
constexpr Colour kInk{0.11, 0.13, 0.15}, kPale{0.87, 0.89, 0.91}, kDim{0.45, 0.49, 0.53};
constexpr Colour kFront{0.04, 0.35, 0.79}, kBehind{0.62, 0.66, 0.70}, kPaper{1, 1, 1};

struct Destroy {
    void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
    void operator()(cairo_t* context) const { cairo_destroy(context); }
};
using Surface = std::unique_ptr<cairo_surface_t, Destroy>;
using Context = std::unique_ptr<cairo_t, Destroy>;

cairo_status_t append(void* text, const unsigned char* data, unsigned length) {
    static_cast<std::string*>(text)->append(reinterpret_cast<const char*>(data), length);
    return CAIRO_STATUS_SUCCESS;
}

std::string shortNumber(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.4g", value);
    return text;
}

/// Round numbers from `low` to `high`, some five of them.
std::vector<double> evenTicks(double low, double high) {
    const double raw = (high - low) / 5;
    const double power = std::pow(10, std::floor(std::log10(raw)));
    const double factor = raw / power < 1.5   ? 1
                          : raw / power < 3.5 ? 2
                          : raw / power < 7.5 ? 5
                                              : 10;
    std::vector<double> ticks;
    for (double i = std::ceil(low / (factor * power)); i * factor * power <= high; ++i) {
        ticks.push_back(i * factor * power);
    }
    return ticks;
}

/// 1, 2 and 5 of each power of ten between the two.
std::vector<double> logTicks(double low, double high) {
    std::vector<double> ticks;
    for (double power = std::floor(std::log10(low)); power <= std::log10(high); ++power) {
        for (double factor : {1.0, 2.0, 5.0}) {
            const double tick = factor * std::pow(10, power);
            if (tick >= low && tick <= high) {
                ticks.push_back(tick);
            }
        }
    }
    return ticks;
}

/// From values to places in a panel.
class Scales {
  public:
    Scales(const PlotPanel& panel, const Box& area) : area_(area), up_(panel.larger_is_better) {
        low_ms_ = high_ms_ = panel.points.front().ms;
        low_ = high_ = panel.points.front().value;
        for (const PlotPoint& point : panel.points) {
            low_ms_ = std::min(low_ms_, point.ms);
            high_ms_ = std::max(high_ms_, point.ms);
            low_ = std::min(low_, point.value);
            high_ = std::max(high_, point.value);
        }
        low_ms_ /= 1.25;
        high_ms_ *= 1.35;
        const double margin = high_ > low_ ? (high_ - low_) * 0.09 : std::abs(low_) * 0.1 + 1e-3;
        low_ -= margin;
        high_ += margin;
    }
    double x(double ms) const {
        return area_.x + area_.width * std::log(ms / low_ms_) / std::log(high_ms_ / low_ms_);
    }
    double y(double value) const {
        const double share = (value - low_) / (high_ - low_);
        return area_.y + area_.height * (up_ ? 1 - share : share);
    }
    std::vector<double> ticksX() const { return logTicks(low_ms_, high_ms_); }
    std::vector<double> ticksY() const { return evenTicks(std::max(low_, 0.0), high_); }

  private:
    Box area_;
    bool up_;
    double low_ms_, high_ms_, low_, high_;
};

/// Stairs: what the offers on the front beat lies right of and below them.
std::vector<Box> frontLines(const PlotPanel& panel, const Scales& scales, const Box& area) {
    std::vector<const PlotPoint*> offers;
    for (const PlotPoint& point : panel.points) {
        if (point.on_front) {
            offers.push_back(&point);
        }
    }
    std::stable_sort(offers.begin(), offers.end(),
                     [](const PlotPoint* a, const PlotPoint* b) { return a->ms < b->ms; });
    std::vector<Box> lines;
    double y = area.y + area.height;
    for (size_t i = 0; i < offers.size(); ++i) {
        const double x = scales.x(offers[i]->ms);
        const double next =
            i + 1 < offers.size() ? scales.x(offers[i + 1]->ms) : area.x + area.width;
        const double top = scales.y(offers[i]->value);
        lines.push_back({x - kFrontWidth / 2, top, kFrontWidth, y - top});
        lines.push_back({x, top - kFrontWidth / 2, next - x, kFrontWidth});
        y = top;
    }
    return lines;
}

class Drawing {
  public:
    explicit Drawing(cairo_t* context) : c_(context) {}
    void draw(const Plot& plot, double width, double height);

  private:
    enum class Align { left, centre, right };
    void colour(const Colour& colour) { cairo_set_source_rgb(c_, colour.r, colour.g, colour.b); }
    void font(double size, bool bold = false);
    double textWidth(const std::string& text);
    void text(double x, double y, const std::string& text, Align align = Align::left);
    void line(double x0, double y0, double x1, double y1);
    void marker(double x, double y, PointKind kind, bool on_front);
    void panel(const PlotPanel& panel, const Box& outer);
    void axes(const PlotPanel& panel, const Scales& scales, const Box& area);
    void points(const PlotPanel& panel, const Scales& scales, const Box& area);
    void key(double y);

    cairo_t* c_;
};

void Drawing::font(double size, bool bold) {
    cairo_select_font_face(c_, kFont, CAIRO_FONT_SLANT_NORMAL,
                           bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(c_, size);
}

double Drawing::textWidth(const std::string& text) {
    cairo_text_extents_t extents{};
    cairo_text_extents(c_, text.c_str(), &extents);
    return extents.x_advance;
}

void Drawing::text(double x, double y, const std::string& text, Align align) {
    const double width = align == Align::left ? 0 : textWidth(text);
    cairo_move_to(c_, align == Align::centre ? x - width / 2 : x - width, y);
    cairo_show_text(c_, text.c_str());
}

void Drawing::line(double x0, double y0, double x1, double y1) {
    cairo_move_to(c_, x0, y0);
    cairo_line_to(c_, x1, y1);
    cairo_stroke(c_);
}

void Drawing::marker(double x, double y, PointKind kind, bool on_front) {
    const double r = kMarkerRadius;
    cairo_new_path(c_);
    if (kind == PointKind::temporal) {
        cairo_arc(c_, x, y, r, 0, 2 * 3.14159265358979);
    } else if (kind == PointKind::supersampled) {
        cairo_rectangle(c_, x - r, y - r, 2 * r, 2 * r);
    } else {
        cairo_move_to(c_, x, y - r * 1.3);
        cairo_line_to(c_, x + r * 1.3, y + r);
        cairo_line_to(c_, x - r * 1.3, y + r);
        cairo_close_path(c_);
    }
    colour(on_front ? kFront : kBehind);
    cairo_fill_preserve(c_);
    colour(kPaper);
    cairo_set_line_width(c_, 1);
    cairo_stroke(c_);
}

void Drawing::axes(const PlotPanel& panel, const Scales& scales, const Box& area) {
    const double bottom = area.y + area.height;
    font(11);
    cairo_set_line_width(c_, 1);
    for (double tick : scales.ticksX()) {
        colour(kPale);
        line(scales.x(tick), area.y, scales.x(tick), bottom);
        colour(kDim);
        text(scales.x(tick), bottom + 16, shortNumber(tick), Align::centre);
    }
    for (double tick : scales.ticksY()) {
        colour(kPale);
        line(area.x, scales.y(tick), area.x + area.width, scales.y(tick));
        colour(kDim);
        text(area.x - 6, scales.y(tick) + 4, shortNumber(tick), Align::right);
    }
    colour(kDim);
    line(area.x, bottom, area.x + area.width, bottom);
    line(area.x, area.y, area.x, bottom);
    text(area.x + area.width, bottom + 34, "milliseconds per frame", Align::right);
    text(area.x - kLeft + 12, area.y - 8, panel.measure + "  (better is up and left)");
}

void Drawing::points(const PlotPanel& panel, const Scales& scales, const Box& area) {
    std::vector<LabelledPoint> labelled;
    for (const PlotPoint& point : panel.points) {
        font(kLabelSize, point.on_front);
        labelled.push_back(
            {scales.x(point.ms), scales.y(point.value), textWidth(point.name) + 2, kLabelSize + 2});
    }
    const std::vector<Box> front = frontLines(panel, scales, area);
    const std::vector<PlacedLabel> labels = placeLabels(labelled, front, area);
    colour(kFront);
    for (const Box& box : front) {
        cairo_rectangle(c_, box.x, box.y, box.width, box.height);
        cairo_fill(c_);
    }
    cairo_set_line_width(c_, 0.8);
    for (size_t i = 0; i < labels.size(); ++i) {
        if (labels[i].leader) {
            colour(kBehind);
            line(labelled[i].x, labelled[i].y, labels[i].leader_x, labels[i].leader_y);
        }
    }
    for (size_t i = 0; i < labels.size(); ++i) {
        const PlotPoint& point = panel.points[i];
        marker(labelled[i].x, labelled[i].y, point.kind, point.on_front);
        font(kLabelSize, point.on_front);
        colour(point.on_front ? kInk : kDim);
        text(labels[i].box.x + 1, labels[i].box.y + kLabelSize, point.name);
    }
}

void Drawing::panel(const PlotPanel& panel, const Box& outer) {
    const Box area{outer.x + kLeft, outer.y + kTop, outer.width - kLeft - kRight,
                   outer.height - kTop - kBottom};
    font(13, true);
    colour(kInk);
    text(area.x + area.width, area.y - 8, panel.title, Align::right);
    const Scales scales(panel, area);
    axes(panel, scales, area);
    points(panel, scales, area);
}

void Drawing::key(double y) {
    struct Entry {
        PointKind kind;
        bool on_front;
        const char* text;
    };
    constexpr Entry kEntries[] = {
        {PointKind::temporal, false, "temporal"},
        {PointKind::spatial, false, "spatial filter"},
        {PointKind::supersampled, false, "one sample, or supersampled"},
        {PointKind::temporal, true, "on the Pareto front: nothing is both cheaper and better"}};
    double x = kLeft;
    font(12);
    for (const Entry& entry : kEntries) {
        marker(x, y - 4, entry.kind, entry.on_front);
        colour(kDim);
        text(x + 10, y, entry.text);
        x += textWidth(entry.text) + 36;
    }
}

void Drawing::draw(const Plot& plot, double width, double height) {
    colour(kPaper);
    cairo_rectangle(c_, 0, 0, width, height);
    cairo_fill(c_);
    colour(kInk);
    font(16, true);
    text(kLeft, 30, plot.title);
    for (size_t i = 0; i < plot.panels.size(); ++i) {
        panel(plot.panels[i],
              {double(i % 2) * kPanelWidth, kTitleHeight + double(i / 2) * kPanelHeight,
               kPanelWidth, kPanelHeight});
    }
    key(height - 10);
}

/// What is drawn on the surface, and whether that worked.
Outcome<void> drawOn(cairo_surface_t* surface, const Plot& plot, double width, double height,
                     double scale) {
    const Context context(cairo_create(surface));
    cairo_scale(context.get(), scale, scale);
    Drawing(context.get()).draw(plot, width, height);
    cairo_surface_flush(surface);
    if (const cairo_status_t status = cairo_status(context.get()); status != CAIRO_STATUS_SUCCESS) {
        return fileError(std::string("the chart: cannot draw: ") + cairo_status_to_string(status));
    }
    return {};
}

}  // namespace

Outcome<PlotFiles> drawPlot(const Plot& plot) {
    constexpr double kPngScale = 1.5;
    const double width = 2 * kPanelWidth;
    const double rows = double((plot.panels.size() + 1) / 2);
    const double height = kTitleHeight + rows * kPanelHeight + kFootHeight;
    PlotFiles files;
    {
        const Surface svg(cairo_svg_surface_create_for_stream(append, &files.svg, width, height));
        if (auto drawn = drawOn(svg.get(), plot, width, height, 1); !drawn) {
            return tl::make_unexpected(drawn.error());
        }
        cairo_surface_finish(svg.get());
    }
    const Surface image(cairo_image_surface_create(CAIRO_FORMAT_RGB24, int(width * kPngScale),
                                                   int(height * kPngScale)));
    return drawOn(image.get(), plot, width, height, kPngScale).map([&] {
        cairo_surface_write_to_png_stream(image.get(), append, &files.png);
        return std::move(files);
    });
}

}  // namespace still::command
