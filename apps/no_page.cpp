#include "apps/page.h"

namespace lyr::command_line {

Status serve_page(const Program&, const PageOptions&) {
    return Diagnostic{Severity::error,
                      ExitStatus::unsupported,
                      "this lyrctl has no page: it was built without libmicrohttpd",
                      {}};
}

}  // namespace lyr::command_line
