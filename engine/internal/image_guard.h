#pragma once
// What has to be put right or refused before stb_image 2.27 may see a file: defects of the decoder
// that only broken or unusual files reach.

#include <cstdint>
#include <span>
#include <vector>

namespace still {

/// The decoder leaves palette entries that a BMP or PNG does not have uninitialised, although
/// pixels may use them, and loses the last four of OS/2 BMPs (12-byte header, 3 bytes an entry). So
/// short palettes are filled up to 256 entries with black. Empty when there is nothing to do.
std::vector<uint8_t> withFullPalette(std::span<const uint8_t> bytes);

/// Whether a JPEG defines a Huffman table of more than 256 codes: the decoder writes them past the
/// end of its table.
bool hasOversizedHuffmanTable(std::span<const uint8_t> bytes);

}  // namespace still
