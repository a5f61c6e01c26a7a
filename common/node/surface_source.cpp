#include "common/node/surface_source.hpp"

#include "common/log/log.hpp"
#include "common/node/contact_feed.hpp"
#include "common/realtime/clock.hpp"

namespace palpate {
namespace {

constexpr std::uint64_t kLateSteps = 2000;

std::span<const Eigen::Vector3f> as_vectors(const std::vector<float>& xyz) {
  return {reinterpret_cast<const Eigen::Vector3f*>(xyz.data()), xyz.size() / 3};
}
std::span<Eigen::Vector3f> as_vectors(std::vector<float>& xyz) {
  return {reinterpret_cast<Eigen::Vector3f*>(xyz.data()), xyz.size() / 3};
}

// Nothing where both are near the same place.
void count_from(const Eigen::Vector3d& origin, const Eigen::Vector3d& before, std::span<Eigen::Vector3f> places) {
  if (before == origin) return;
  for (Eigen::Vector3f& p : places) p = (before - origin + p.cast<double>()).cast<float>();
}

class ReceivedSurfaces : public SurfaceSource {
 public:
  ReceivedSurfaces(Bus& bus, const Presence& presence, std::vector<std::size_t> nodes, const Eigen::Vector3d& origin)
      : presence_(presence),
        reader_(bus.reader(topics::surface_state)),
        nodes_(std::move(nodes)),
        latest_(nodes_.size()),
        origin_(origin) {}

  bool update() override {
    bool news = false;
    while (auto sample = reader_->take()) {
      if (!fits(*sample)) {
        ++refused_;
        continue;
      }
      if (sample->run != 0 && is_newer(*sample)) {
        moment_ = {sample->run, sample->step, sample->sense_ns};
        news = true;
      }
      count_from(origin_, Eigen::Vector3d(sample->origin.data()), as_vectors(sample->position));
      latest_[sample->body] = std::move(*sample);
    }
    return news;
  }

  Shape shape(int body) const override {
    return {as_vectors(latest_[body].position), as_vectors(latest_[body].normal)};
  }
  Moment moment() const override { return moment_; }
  std::uint64_t refused() const override { return refused_; }

 private:
  // A step far behind the one shown is not late: that one's number was not true.
  bool is_newer(const SurfaceState& s) const {
    return s.run != moment_.run || s.step > moment_.step || moment_.step - s.step > kLateSteps;
  }
  bool fits(const SurfaceState& s) const {
    return s.body < nodes_.size() && s.position.size() == 3 * nodes_[s.body] && s.normal.size() == s.position.size() &&
           (s.run == 0 || presence_.accepts(s.run));
  }

  const Presence& presence_;
  std::unique_ptr<Reader<SurfaceState>> reader_;
  std::vector<std::size_t> nodes_;
  std::vector<SurfaceState> latest_;
  Eigen::Vector3d origin_;
  Moment moment_;
  std::uint64_t refused_ = 0;
};

class OwnSurfaces : public SurfaceSource {
 public:
  OwnSurfaces(const Scene& scene, Bus& bus, const Presence& presence, Deformer deformer, const Eigen::Vector3d& origin)
      : deformer_(std::move(deformer)),
        feed_(bus, presence, deformer_),
        range_(scene, deformer_),
        origin_(origin),
        places_(deformer_.bodies()),
        dents_(deformer_.bodies()) {
    deformer_.deform();
    look();
  }

  bool update() override {
    const bool news = feed_.take();
    if (news) {
      deformer_.deform();
      look();
      for (const std::string& said : range_.look(deformer_)) log_warning(said);
    }
    return news;
  }
  void watch(std::int64_t now) override { feed_.watch_haptic(now); }

  Shape shape(int body) const override { return {places_[body], deformer_.surface(body).normal, dents_[body]}; }
  Moment moment() const override { return {deformer_.run(), deformer_.step(), deformer_.sense_ns()}; }
  const RangeMonitor* range() const override { return &range_; }
  std::uint64_t refused() const override { return feed_.refused(); }

 private:
  void look() {
    for (int b = 0; b < deformer_.bodies(); ++b) {
      const BodyShape& shape = deformer_.shape(b);
      places_[b] = deformer_.surface(b).position;
      count_from(origin_, shape.origin(), places_[b]);
      dents_[b].assign(shape.dents().begin(), shape.dents().end());
      for (HertzDent& dent : dents_[b]) dent.middle -= origin_;
    }
  }

  Deformer deformer_;
  ContactFeed feed_;
  RangeMonitor range_;
  Eigen::Vector3d origin_;
  std::vector<std::vector<Eigen::Vector3f>> places_;  ///< per body
  std::vector<std::vector<HertzDent>> dents_;         ///< per body
};

}  // namespace

std::unique_ptr<SurfaceSource> receive_surfaces(Bus& bus, const Presence& presence, std::vector<std::size_t> nodes,
                                                const Eigen::Vector3d& origin) {
  return std::make_unique<ReceivedSurfaces>(bus, presence, std::move(nodes), origin);
}

std::unique_ptr<SurfaceSource> deform_surfaces(const Scene& scene, Bus& bus, const Presence& presence,
                                               Deformer deformer, const Eigen::Vector3d& origin) {
  return std::make_unique<OwnSurfaces>(scene, bus, presence, std::move(deformer), origin);
}

}  // namespace palpate
