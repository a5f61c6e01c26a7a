#include "render_node/surface_source.hpp"

#include <spdlog/spdlog.h>

namespace palpate {
namespace {

std::span<const Eigen::Vector3f> as_vectors(const std::vector<float>& xyz) {
  return {reinterpret_cast<const Eigen::Vector3f*>(xyz.data()), xyz.size() / 3};
}

class ReceivedSurfaces : public SurfaceSource {
 public:
  ReceivedSurfaces(Bus& bus, const Presence& presence, std::vector<std::size_t> nodes)
      : presence_(presence),
        reader_(bus.reader(topics::surface_state)),
        nodes_(std::move(nodes)),
        latest_(nodes_.size()) {}

  bool update() override {
    bool news = false;
    while (auto sample = reader_->take()) {
      if (!fits(*sample)) {
        ++refused_;
        continue;
      }
      news |= sample->sense_ns > sense_ns_;
      sense_ns_ = std::max(sense_ns_, sample->sense_ns);
      latest_[sample->body] = std::move(*sample);
    }
    return news;
  }

  Shape shape(int body) const override {
    return {as_vectors(latest_[body].position), as_vectors(latest_[body].normal)};
  }
  std::int64_t sense_ns() const override { return sense_ns_; }
  std::uint64_t refused() const override { return refused_; }

 private:
  bool fits(const SurfaceState& s) const {
    return s.body < nodes_.size() && s.position.size() == 3 * nodes_[s.body] &&
           s.normal.size() == s.position.size() && (s.run == 0 || presence_.accepts(s.run));
  }

  const Presence& presence_;
  std::unique_ptr<Reader<SurfaceState>> reader_;
  std::vector<std::size_t> nodes_;
  std::vector<SurfaceState> latest_;
  std::int64_t sense_ns_ = 0;
  std::uint64_t refused_ = 0;
};

class OwnSurfaces : public SurfaceSource {
 public:
  OwnSurfaces(Bus& bus, const Presence& presence, Deformer deformer)
      : presence_(presence),
        contacts_(bus.reader(topics::contact_state)),
        held_(bus.writer(topics::held_contacts)),
        deformer_(std::move(deformer)) {
    deformer_.deform();
  }

  bool update() override {
    bool news = false;
    while (const auto contacts = contacts_->take()) {
      const bool good = presence_.accepts(contacts->run) && deformer_.take(*contacts);
      refused_ += !good;
      news |= good;
    }
    if (news) deformer_.deform();
    keep_contacts();
    return news;
  }

  Shape shape(int body) const override {
    const DeformedSurface& surface = deformer_.surface(body);
    return {surface.position, surface.normal};
  }
  std::int64_t sense_ns() const override { return deformer_.sense_ns(); }
  std::uint64_t refused() const override { return refused_; }

 private:
  void keep_contacts() {
    const bool alive = contacts_->writers() > 0;
    if (haptic_alive_ && !alive) {
      int kept = 0;
      for (const auto& [tool, contacts] : deformer_.contacts())
        if (!contacts.contacts.empty()) kept += held_->write(contacts);
      spdlog::warn("the haptic node is gone; keeping the contacts of {} tools for its return", kept);
    }
    haptic_alive_ = alive;
  }

  const Presence& presence_;
  std::unique_ptr<Reader<ContactState>> contacts_;
  std::unique_ptr<Writer<ContactState>> held_;
  Deformer deformer_;
  bool haptic_alive_ = false;
  std::uint64_t refused_ = 0;
};

}  // namespace

std::unique_ptr<SurfaceSource> receive_surfaces(Bus& bus, const Presence& presence,
                                                std::vector<std::size_t> nodes) {
  return std::make_unique<ReceivedSurfaces>(bus, presence, std::move(nodes));
}

std::unique_ptr<SurfaceSource> deform_surfaces(Bus& bus, const Presence& presence, Deformer deformer) {
  return std::make_unique<OwnSurfaces>(bus, presence, std::move(deformer));
}

}  // namespace palpate
