// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/command_line/help.hpp"

#include <string>

#include "app/wrapped_text.hpp"

namespace palpate::app {
namespace {

constexpr std::size_t kUsualColumns = 80;
constexpr std::size_t kDescription = 30;  ///< column where descriptions begin

class WrappedHelp : public CLI::Formatter {
 public:
  explicit WrappedHelp(std::size_t columns) : columns_(columns) { column_width(kDescription); }

  std::string make_help(const CLI::App* app, std::string name,
                        CLI::AppFormatMode mode) const override {
    return wrapped_help(CLI::Formatter::make_help(app, std::move(name), mode), columns_,
                        kDescription);
  }

 private:
  std::size_t columns_;
};

}  // namespace

std::shared_ptr<CLI::Formatter> help_formatter(int columns) {
  return std::make_shared<WrappedHelp>(columns > 0 ? static_cast<std::size_t>(columns)
                                                   : kUsualColumns);
}

}  // namespace palpate::app
