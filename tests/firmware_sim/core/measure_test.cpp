// Promises: I1, I5.
#include "firmware_sim/core/measure.hpp"

#include <gtest/gtest.h>

namespace pinjaw::core::test {
namespace {

Sensors at_rest() {
  return {.close_mbar = {4000, 4000}, .open_mbar = {100, 100}, .supply_mbar = 6000, .separation_10um = 3000};
}

TEST(Measure, force_is_area_times_net_pressure_and_the_spring) {
  Config config;
  EXPECT_EQ(squeeze_dn(config, 4'000'000, 0), 1037);
  EXPECT_EQ(squeeze_dn(config, 4'000'000, 1'000'000), 816) << "85 % of the open side pushes back";
  EXPECT_EQ(squeeze_dn(config, 0, 1'000'000), -220);
  EXPECT_EQ(squeeze_dn(config, 0, 8'000'000), -1762) << "85 % to the last per mille";
  EXPECT_EQ(squeeze_dn(config, 0, 8'004'000), -1763);
  config.spring_dn = 400;
  EXPECT_EQ(squeeze_dn(config, 4'000'000, 0), 1437);
  config.passive = true;
  EXPECT_EQ(squeeze_dn(config, 4'000'000, 0), 0);
}

TEST(Measure, pressure_is_what_makes_a_force_and_never_under_nothing) {
  Config config;
  EXPECT_EQ(pressure_mbar(config, 1037, 0), 3999);
  EXPECT_EQ(pressure_mbar(config, 1037, 1000), 4849);
  EXPECT_EQ(pressure_mbar(config, 1037, 1), 3999);
  EXPECT_EQ(pressure_mbar(config, 1037, -500), 3999) << "a sensor under zero pushes nothing back";
  EXPECT_EQ(pressure_mbar(config, -100, 0), 0);
  EXPECT_EQ(pressure_mbar(config, 100'000, 0), 20000);
  EXPECT_EQ(pressure_mbar(config, 0, 8000), 6800) << "85 % to the last per mille";
  config.spring_dn = 400;
  EXPECT_EQ(pressure_mbar(config, 1037, 0), 2457);
  config.spring_dn = 0;
  config.open_ratio_permille = 1000;
  EXPECT_EQ(pressure_mbar(config, 0, 0), 0);
  config.area_udn_per_mbar = 0;
  EXPECT_EQ(pressure_mbar(config, 1, 0), 20000);
  EXPECT_EQ(pressure_mbar(config, -1, 1'003'000), 3000) << "no area is the least: 1 dn is 1000 bar";
  config.area_udn_per_mbar = 1;
  EXPECT_EQ(pressure_mbar(config, 0, 0), 0);
}

TEST(Measure, time_is_counted_while_something_goes_on_and_a_minute_stands_for_more) {
  EXPECT_EQ(counted(5, true, 3), 8);
  EXPECT_EQ(counted(5, false, 3), 0);
  EXPECT_EQ(counted(59'990, true, 10), 60'000);
  EXPECT_EQ(counted(59'990, true, 11), 60'000);
  EXPECT_EQ(counted(0, true, 999), 999);
  EXPECT_EQ(counted(0, true, 1000), 1000);
  EXPECT_EQ(counted(0, true, 5000), 1000);
}

TEST(Measure, begins_with_the_first_readings_and_then_follows_them_in_eight_milliseconds) {
  const Config config;
  Measurement m;
  EXPECT_FALSE(m.started);
  Sensors sensors = at_rest();
  sensors.close_mbar[1] = 4020;
  sensors.open_mbar = {100, 103};
  observe(config, sensors, 1, m);
  EXPECT_TRUE(m.started);
  EXPECT_EQ(m.close_ubar[0], 4'000'000);
  EXPECT_EQ(m.close_ubar[1], 4'020'000);
  EXPECT_EQ(m.open_ubar, 101'000);
  EXPECT_EQ(m.squeeze.measured_dn, squeeze_dn(config, 4'010'000, 101'000));
  EXPECT_EQ(m.squeeze.low_dn, m.squeeze.measured_dn - 120);
  EXPECT_EQ(m.squeeze.high_dn, m.squeeze.measured_dn + 120);
  sensors.close_mbar = {4800, 4020};
  sensors.open_mbar = {901, 901};
  observe(config, sensors, 1, m);
  EXPECT_EQ(m.close_ubar[0], 4'100'000);
  EXPECT_EQ(m.close_ubar[1], 4'020'000);
  EXPECT_EQ(m.open_ubar, 201'000);
  observe(config, sensors, 4, m);
  EXPECT_EQ(m.close_ubar[0], 4'450'000);
  observe(config, sensors, 500, m);
  EXPECT_EQ(m.close_ubar[0], 4'800'000) << "never past the reading";
  sensors.close_mbar[1] = 4820;
  observe(config, sensors, 1, m);
  EXPECT_EQ(m.close_ubar[1], 4'120'000);
  EXPECT_EQ(m.supply_mbar, 6000);
  EXPECT_EQ(m.separation_10um, 3000);
}

TEST(Measure, a_reading_that_cannot_be_is_cut_to_what_can) {
  const Config config;
  Measurement low;
  Sensors sensors = at_rest();
  sensors.close_mbar = {-5000, -1000};
  sensors.open_mbar = {-5000, -5000};
  observe(config, sensors, 1, low);
  EXPECT_EQ(low.close_ubar[0], -1'000'000);
  EXPECT_EQ(low.close_ubar[1], -1'000'000);
  EXPECT_EQ(low.open_ubar, -1'000'000);
  Measurement high;
  sensors.close_mbar = {30000, 20000};
  observe(config, sensors, 1, high);
  EXPECT_EQ(high.close_ubar[0], 20'000'000);
  EXPECT_EQ(high.close_ubar[1], 20'000'000);
}

TEST(Measure, jaws_do_not_stand_still_before_they_were_seen_twice) {
  Measurement m;
  observe(Config{}, Sensors{.separation_10um = 0}, 1, m);
  EXPECT_EQ(m.still_ms, 0);
  observe(Config{}, Sensors{.separation_10um = 0}, 1, m);
  EXPECT_EQ(m.still_ms, 1);
}

TEST(Measure, jaws_stand_still_within_thirty_micrometres_of_where_they_stopped) {
  const Config config;
  for (const int direction : {1, -1}) {
    Measurement m;
    Sensors sensors = at_rest();
    observe(config, sensors, 1, m);
    EXPECT_EQ(m.still_ms, 0) << "one reading tells nothing";
    observe(config, sensors, 2, m);
    EXPECT_EQ(m.still_ms, 2);
    sensors.separation_10um = 3000 + 3 * direction;
    observe(config, sensors, 1, m);
    EXPECT_EQ(m.still_ms, 3);
    sensors.separation_10um = 3000 + 4 * direction;
    observe(config, sensors, 1, m);
    EXPECT_EQ(m.still_ms, 0);
    EXPECT_EQ(m.still_at_10um, 3000 + 4 * direction);
  }
}

SensorTrouble trouble_with(const Sensors& sensors, Config config = {}) {
  Measurement m;
  for (int ms = 0; ms < 2; ++ms) {
    observe(config, sensors, 1, m);
    EXPECT_EQ(m.trouble, SensorTrouble::None) << "2 ms are not yet 3";
  }
  observe(config, sensors, 1, m);
  EXPECT_EQ(m.trouble, m.suspected);
  return m.trouble;
}

TEST(Measure, speed_is_what_the_separation_lost_over_the_last_milliseconds) {
  for (const std::int32_t step_ms : {1, 2, 5}) {
    const Config config;
    Measurement m;
    Sensors sensors = at_rest();
    observe(config, sensors, 1, m);
    EXPECT_EQ(m.closing_mm_s, 0) << "the first reading says nothing of speed";
    for (int ms = 0; ms < 200; ms += step_ms) {
      sensors.separation_10um -= 6 * step_ms;
      observe(config, sensors, static_cast<std::uint32_t>(step_ms), m);
    }
    EXPECT_NEAR(m.closing_mm_s, 60, 4 * step_ms) << "60 mm/s are 6 steps of 10 um a millisecond";
    for (int ms = 0; ms < 100; ++ms) observe(config, sensors, 1, m);
    EXPECT_EQ(m.closing_mm_s, 0);
    sensors.separation_10um += 160;
    observe(config, sensors, 1000, m);
    EXPECT_EQ(m.closing_mm_s, 0) << "a long step is all there is to know";
  }
}

TEST(Measure, speed_lags_by_a_sixteenth_a_millisecond) {
  Measurement m;
  Sensors sensors = at_rest();
  observe(Config{}, sensors, 1, m);
  EXPECT_EQ(m.lagging_um, 30'000);
  sensors.separation_10um -= 160;
  observe(Config{}, sensors, 1, m);
  EXPECT_EQ(m.lagging_um, 29'900);
  EXPECT_EQ(m.closing_mm_s, 1500 / 16);
  observe(Config{}, sensors, 16, m);
  EXPECT_EQ(m.lagging_um, 28'400);
  EXPECT_EQ(m.closing_mm_s, 0);
}

TEST(Measure, a_pressure_out_of_range_is_trouble_after_3_ms_whichever_sensor_it_is) {
  for (int sensor = 0; sensor < 4; ++sensor) {
    for (const auto& [reading_mbar, bad] :
         {std::pair{-700, false}, {-701, true}, {9900, false}, {9901, true}}) {
      // its twin of the same chamber reads the last value that is believed
      Sensors sensors = at_rest();
      std::array<std::int32_t, 2>& chamber = sensor < 2 ? sensors.close_mbar : sensors.open_mbar;
      chamber.fill(reading_mbar < 0 ? -700 : 9900);
      chamber[static_cast<std::size_t>(sensor % 2)] = reading_mbar;
      EXPECT_EQ(trouble_with(sensors), bad ? SensorTrouble::PressureRange : SensorTrouble::None)
          << sensor << ' ' << reading_mbar;
    }
  }
}

TEST(Measure, sensors_300_mbar_apart_agree_and_301_do_not) {
  for (const int sign : {1, -1}) {
    Sensors sensors = at_rest();
    sensors.close_mbar[0] += sign * 300;
    EXPECT_EQ(trouble_with(sensors), SensorTrouble::None);
    sensors.close_mbar[0] += sign;
    EXPECT_EQ(trouble_with(sensors), SensorTrouble::Disagreement);
  }
}

TEST(Measure, a_separation_2_mm_past_an_end_stop_is_believed_and_more_is_not) {
  for (const auto& [separation_10um, bad] :
       {std::pair{-200, false}, {-201, true}, {6200, false}, {6201, true}}) {
    Sensors sensors = at_rest();
    sensors.separation_10um = separation_10um;
    EXPECT_EQ(trouble_with(sensors), bad ? SensorTrouble::Position : SensorTrouble::None) << separation_10um;
    EXPECT_EQ(trouble_with(sensors, {.passive = true}), SensorTrouble::None);
  }
}

TEST(Measure, trouble_that_goes_is_forgotten_at_once) {
  const Config config;
  Measurement m;
  Sensors sensors = at_rest();
  sensors.separation_10um = 7000;
  observe(config, sensors, 2, m);
  EXPECT_EQ(m.suspected, SensorTrouble::Position);
  observe(config, at_rest(), 1, m);
  EXPECT_EQ(m.suspected, SensorTrouble::None);
  observe(config, sensors, 2, m);
  EXPECT_EQ(m.trouble, SensorTrouble::None) << "the count began anew";
}

TEST(Measure, supply_air_is_low_after_50_ms_under_its_limit) {
  Config config;
  Measurement m;
  Sensors sensors = at_rest();
  sensors.supply_mbar = 4500;
  observe(config, sensors, 1000, m);
  EXPECT_FALSE(m.supply_low) << "at the limit";
  sensors.supply_mbar = 4499;
  observe(config, sensors, 49, m);
  EXPECT_FALSE(m.supply_low);
  observe(config, sensors, 1, m);
  EXPECT_TRUE(m.supply_low);
  config.passive = true;
  observe(config, sensors, 100, m);
  EXPECT_FALSE(m.supply_low);
}

TEST(Measure, seats_are_on_when_every_switch_is_and_clear_when_none_is) {
  const Config config{.passive = true, .seat_switches = 7};
  const auto seen = [&config](std::uint8_t seats) {
    Sensors sensors;
    sensors.seats = seats;
    Measurement m;
    observe(config, sensors, 1, m);
    return std::pair(m.seated, m.seats_clear);
  };
  EXPECT_EQ(seen(7), std::pair(true, false));
  EXPECT_EQ(seen(15), std::pair(true, false));
  EXPECT_EQ(seen(3), std::pair(false, false));
  EXPECT_EQ(seen(6), std::pair(false, false));
  EXPECT_EQ(seen(0), std::pair(false, true));
  EXPECT_EQ(seen(8), std::pair(false, true)) << "a switch that it does not have";
  Sensors sensors;
  sensors.local_enable = true;
  Measurement m;
  observe(config, sensors, 1, m);
  EXPECT_TRUE(m.local_enable);
}

}  // namespace
}  // namespace pinjaw::core::test
