// Panels of a run -> one page.
#include "tools/image/storyboard.h"

#include "tools/image/lettering.h"

#include <algorithm>
#include <cassert>

namespace patchlight {
namespace {

constexpr uint32_t kPageWidth = 1920, kColumns = 4;
constexpr uint32_t kMargin = 32, kGap = 20;
constexpr float kLettersMin = 9, kLettersMax = 26;
const Rgb kInk{0.012f}, kPaleInk{0.13f}, kPaper{1};

// Sizes of a page, pixels.
struct Page {
  uint32_t columns, rows, panel_width, panel_height;
  uint32_t letters;  // an em
  uint32_t line() const { return letters * 3 / 2; }
  uint32_t title_height() const { return letters * 5 / 2; }
  uint32_t row_height() const { return 2 * (line() + panel_height) + kGap + kGap / 2; }
  uint32_t left(uint32_t column) const { return kMargin + column * (panel_width + kGap); }
  uint32_t width() const { return left(columns) - kGap + kMargin; }
  uint32_t top(uint32_t row) const { return kMargin + title_height() + row * row_height(); }
};

// As few rows as kColumns allow, all about equally long: five panels stand as three and two.
uint32_t count_columns(size_t panel_count) {
  const auto count = static_cast<uint32_t>(std::max<size_t>(panel_count, 1));
  const uint32_t rows = (count + kColumns - 1) / kColumns;
  return (count + rows - 1) / rows;
}

Page make_page(const Storyboard& storyboard) {
  const Picture& first = storyboard.panels.front().lit;
  const auto count = static_cast<uint32_t>(storyboard.panels.size());
  const uint32_t columns = count_columns(count);
  const auto letters =
      static_cast<uint32_t>(std::clamp(static_cast<float>(first.width) / 22, kLettersMin, kLettersMax));
  return {columns, (count + columns - 1) / columns, first.width, first.height, letters};
}

// A picture with a line of text above it, which starts at the left and ends at the right; the end gives way
// where there is not room for both. Returns the first free row below.
uint32_t place_panel(Picture& page, uint32_t x, uint32_t y, const Page& sizes, const std::string& label,
                     const std::string& note, const Picture& panel) {
  const auto size = static_cast<float>(sizes.letters);
  const auto baseline = static_cast<float>(y + sizes.letters);
  const auto left = static_cast<float>(x), width = static_cast<float>(panel.width);
  draw_text(page, left, baseline, label, {size, kInk});
  if (measure_text(label, size) + measure_text(note, size) + size < width)
    draw_text(page, left + width, baseline, note, {size, kPaleInk, TextAlign::kRight});
  place_picture(page, panel, x, y + sizes.line());
  return y + sizes.line() + panel.height;
}

}  // namespace

uint32_t find_panel_width(size_t panel_count, uint32_t picture_width) {
  const uint32_t columns = count_columns(panel_count);
  return std::min(picture_width, (kPageWidth - 2 * kMargin - (columns - 1) * kGap) / columns);
}

Picture compose_storyboard(const Storyboard& storyboard) {
  assert(!storyboard.panels.empty());
  const Page sizes = make_page(storyboard);
  const uint32_t scale_height = storyboard.scales.empty() ? 0 : sizes.letters * 4 + kGap / 2;
  const uint32_t height = sizes.top(sizes.rows) + scale_height - kGap / 2 + kMargin;
  Picture page = make_picture(sizes.width(), height, kPaper);
  const float title_size = 1.5f * static_cast<float>(sizes.letters);
  const auto title_line = static_cast<float>(kMargin) + title_size;
  const auto right = static_cast<float>(sizes.width() - kMargin);
  draw_text(page, kMargin, title_line, storyboard.title, {title_size, kInk});
  const auto size = static_cast<float>(sizes.letters);
  if (measure_text(storyboard.title, title_size) + measure_text(storyboard.note, size) + size <
      right - static_cast<float>(kMargin))
    draw_text(page, right, title_line, storyboard.note, {size, kPaleInk, TextAlign::kRight});
  for (uint32_t k = 0; k < storyboard.panels.size(); ++k) {
    const StoryPanel& panel = storyboard.panels[k];
    const uint32_t x = sizes.left(k % sizes.columns), y = sizes.top(k / sizes.columns);
    const uint32_t below = place_panel(page, x, y, sizes, panel.lit_label, panel.lit_note, panel.lit);
    place_panel(page, x, below + kGap / 2, sizes, panel.added_label, panel.added_note, panel.added);
  }
  // Legends share the width.
  const auto count = static_cast<uint32_t>(storyboard.scales.size());
  for (uint32_t k = 0; k < count; ++k) {
    const uint32_t part = (page.width - 2 * kMargin - (count - 1) * 2 * kMargin) / count;
    const uint32_t width = std::min(part, sizes.letters * 36);
    draw_scale(page, {kMargin + k * (part + 2 * kMargin), sizes.top(sizes.rows), width, sizes.letters * 4},
               storyboard.scales[k], size, kInk);
  }
  return page;
}

}  // namespace patchlight
