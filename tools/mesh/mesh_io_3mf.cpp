// 3MF, for printing: a zip (by libarchive) of three XML files. Lengths are millimetres.
#include <archive.h>
#include <archive_entry.h>

#include <exception>
#include <memory>

#include "tools/file/failure.h"
#include "tools/file/text.h"
#include "tools/mesh/mesh_io_formats.h"

namespace plc::tools {
namespace {

constexpr const char* kContentTypes =
    "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
    "<Types xmlns=\"http://schemas.openxmlformats.org/package/2006/content-types\">"
    "<Default Extension=\"rels\" "
    "ContentType=\"application/vnd.openxmlformats-package.relationships+xml\"/>"
    "<Default Extension=\"model\" "
    "ContentType=\"application/vnd.ms-package.3dmanufacturing-3dmodel+xml\"/></Types>\n";
constexpr const char* kRelations =
    "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
    "<Relationships xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\">"
    "<Relationship Target=\"/3D/3dmodel.model\" Id=\"rel0\" "
    "Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>\n";

std::string model_of(const TriangleMesh& mesh) {
  std::string out =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model unit=\"millimeter\" xml:lang=\"en-US\" "
      "xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\">\n"
      "<metadata name=\"Application\">Pellicle</metadata>\n";
  if (!mesh.space.empty()) {
    out += "<metadata name=\"Description\">" + space_comment(mesh) + "</metadata>\n";
  }
  out += "<resources>\n<object id=\"1\" type=\"model\">\n<mesh>\n<vertices>\n";
  for (size_t i = 0; i < mesh.xyz.size(); i += 3) {
    out += "<vertex x=\"";
    put_real(out, mesh.xyz[i], mesh.doubles);
    out += "\" y=\"";
    put_real(out, mesh.xyz[i + 1], mesh.doubles);
    out += "\" z=\"";
    put_real(out, mesh.xyz[i + 2], mesh.doubles);
    out += "\"/>\n";
  }
  out += "</vertices>\n<triangles>\n";
  for (size_t i = 0; i < mesh.abc.size(); i += 3) {
    out += "<triangle v1=\"";
    put_integer(out, mesh.abc[i]);
    out += "\" v2=\"";
    put_integer(out, mesh.abc[i + 1]);
    out += "\" v3=\"";
    put_integer(out, mesh.abc[i + 2]);
    out += "\"/>\n";
  }
  return out +
         "</triangles>\n</mesh>\n</object>\n</resources>\n<build>\n<item objectid=\"1\"/>\n"
         "</build>\n</model>\n";
}

// Between libarchive, which is C, and the file, which may throw: exceptions wait until it is left.
class Zip {
 public:
  explicit Zip(AtomicFile& file) : file_(file), archive_(archive_write_new(), archive_write_free) {
    if (archive_ == nullptr) throw std::bad_alloc();
    demand(archive_write_set_format_zip(archive_.get()));
    demand(archive_write_set_bytes_in_last_block(archive_.get(), 1));
    demand(archive_write_open(archive_.get(), this, nullptr, on_write, nullptr));
  }

  void add(const char* name, const std::string& text) {
    const std::unique_ptr<archive_entry, void (*)(archive_entry*)> entry(archive_entry_new(),
                                                                         archive_entry_free);
    if (entry == nullptr) throw std::bad_alloc();
    constexpr time_t kFirstDay = 315532800;  // of 1980, where a zip's time begins
    archive_entry_set_pathname(entry.get(), name);
    archive_entry_set_size(entry.get(), static_cast<int64_t>(text.size()));
    archive_entry_set_filetype(entry.get(), AE_IFREG);
    archive_entry_set_perm(entry.get(), 0644);
    archive_entry_set_mtime(entry.get(), kFirstDay, 0);
    demand(archive_write_header(archive_.get(), entry.get()));
    for (size_t done = 0; done < text.size();) {
      const la_ssize_t put =
          archive_write_data(archive_.get(), text.data() + done, text.size() - done);
      demand(put > 0 ? ARCHIVE_OK : ARCHIVE_FATAL);
      done += static_cast<size_t>(put);
    }
    demand(archive_write_finish_entry(archive_.get()));
  }
  void close() { demand(archive_write_close(archive_.get())); }

 private:
  static la_ssize_t on_write(archive*, void* self, const void* data, size_t size) {
    auto* zip = static_cast<Zip*>(self);
    if (zip->thrown_ != nullptr) return -1;
    try {
      zip->file_.write(data, size);
    } catch (...) {
      zip->thrown_ = std::current_exception();
      return -1;
    }
    return static_cast<la_ssize_t>(size);
  }
  void demand(int status) const {
    if (thrown_ != nullptr) std::rethrow_exception(thrown_);
    if (status == ARCHIVE_OK) return;
    const char* why = archive_error_string(archive_.get());
    throw Failure{std::string("a 3MF file cannot be packed: ") + (why != nullptr ? why : "")};
  }

  AtomicFile& file_;
  std::exception_ptr thrown_;  // before the archive, which may write once more when it is freed
  std::unique_ptr<archive, int (*)(archive*)> archive_;
};

}  // namespace

void write_3mf(AtomicFile& file, const TriangleMesh& mesh) {
  Zip zip(file);
  zip.add("[Content_Types].xml", kContentTypes);
  zip.add("_rels/.rels", kRelations);
  zip.add("3D/3dmodel.model", model_of(mesh));
  zip.close();
}

}  // namespace plc::tools
