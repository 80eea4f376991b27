// Frames -> GIF in memory, by giflib: what every browser and every slide program plays. Each frame has a
// palette of its own.
#include "tools/export/exporters.h"

#include <gif_lib.h>

#include <algorithm>
#include <cassert>
#include <memory>
#include <stdexcept>

namespace patchlight {
namespace {

int take_bytes(GifFileType* gif, const GifByteType* bytes, int count) {
  static_cast<std::string*>(gif->UserData)
      ->append(reinterpret_cast<const char*>(bytes), static_cast<size_t>(count));
  return count;
}

void check(bool done, int code) {
  if (done) return;
  const char* words = GifErrorString(code);
  throw std::runtime_error(std::string("giflib: ") + (words != nullptr ? words : "no reason given"));
}

struct CloseGif {
  void operator()(GifFileType* gif) const { EGifCloseFile(gif, nullptr); }
};
struct FreeMap {
  void operator()(ColorMapObject* map) const { GifFreeMapObject(map); }
};

// The extension that all readers know from Netscape's: repeat for ever.
void put_repeat(GifFileType* gif) {
  constexpr GifByteType kForEver[3] = {1, 0, 0};
  check(EGifPutExtensionLeader(gif, APPLICATION_EXT_FUNC_CODE) == GIF_OK &&
            EGifPutExtensionBlock(gif, 11, "NETSCAPE2.0") == GIF_OK &&
            EGifPutExtensionBlock(gif, sizeof kForEver, kForEver) == GIF_OK &&
            EGifPutExtensionTrailer(gif) == GIF_OK,
        gif->Error);
}

void put_frame(GifFileType* gif, const BytePicture& frame, double seconds) {
  const Palette palette = pick_palette(frame);
  // Sizes of palettes are powers of two.
  int size = 2;
  while (static_cast<size_t>(size) < palette.size()) size *= 2;
  const std::unique_ptr<ColorMapObject, FreeMap> map(GifMakeMapObject(size, nullptr));
  if (map == nullptr) throw std::bad_alloc();
  for (size_t k = 0; k < static_cast<size_t>(size); ++k) {
    const auto color = k < palette.size() ? palette[k] : std::array<uint8_t, 3>{};
    map->Colors[k] = {color[0], color[1], color[2]};
  }
  const GraphicsControlBlock control{.DisposalMode = DISPOSE_DO_NOT,
                                     .UserInputFlag = false,
                                     .DelayTime = static_cast<int>(seconds * 100 + 0.5),
                                     .TransparentColor = NO_TRANSPARENT_COLOR};
  GifByteType bytes[4];
  const size_t count = EGifGCBToExtension(&control, bytes);
  check(EGifPutExtension(gif, GRAPHICS_EXT_FUNC_CODE, static_cast<int>(count), bytes) == GIF_OK, gif->Error);
  const int width = static_cast<int>(frame.width), height = static_cast<int>(frame.height);
  check(EGifPutImageDesc(gif, 0, 0, width, height, false, map.get()) == GIF_OK, gif->Error);
  std::vector<uint8_t> indices = index_pixels(frame, palette);
  for (size_t y = 0; y < frame.height; ++y)
    check(EGifPutLine(gif, indices.data() + y * frame.width, width) == GIF_OK, gif->Error);
}

}  // namespace

std::string encode_gif(const Animation& animation) {
  assert(!animation.frames.empty());
  std::string file;
  int error = 0;
  std::unique_ptr<GifFileType, CloseGif> gif(EGifOpen(&file, take_bytes, &error));
  check(gif != nullptr, error);
  EGifSetGifVersion(gif.get(), true);
  const BytePicture& first = animation.frames.front();
  check(EGifPutScreenDesc(gif.get(), static_cast<int>(first.width), static_cast<int>(first.height), 8, 0,
                          nullptr) == GIF_OK,
        gif->Error);
  put_repeat(gif.get());
  for (size_t k = 0; k < animation.frames.size(); ++k)
    put_frame(gif.get(), animation.frames[k], animation.seconds[k]);
  check(EGifCloseFile(gif.release(), &error) == GIF_OK, error);
  return file;
}

}  // namespace patchlight
