#pragma once
// Linear light to 8-bit output: sRGB encoding and optional tone mapping, both by table.

#include <array>
#include <cstdint>
#include <memory>
#include <span>

#include "postfx/taa.h"

namespace still {

enum class ToneMap {
    none,      ///< values above 1.0 saturate
    reinhard,  ///< c · (1 + c/16²) / (1 + c) per channel (Reinhard 2002, eq. 4, white = 16)
};

/// The table for fx12 inputs 0 … 65535. Computed with + − × ÷ √ only, equal everywhere.
class OutputTable {
  public:
    /// Light is multiplied by `exposure` ≥ 0 first.
    explicit OutputTable(ToneMap tone_map = ToneMap::none, double exposure = 1);
    uint8_t operator[](uint16_t linear_fx12) const { return table_[linear_fx12]; }

  private:
    std::array<uint8_t, 65536> table_;
};

/// Writes width × height pixels, or those of the tiles that `changed` (not 0; empty: all). Views
/// have equal sizes.
void encodeOutput(const ColourPlanes& colour, const OutputTable& table, ImageView<Rgb8> out,
                  Workers& workers, std::span<const uint8_t> changed = {});

}  // namespace still
