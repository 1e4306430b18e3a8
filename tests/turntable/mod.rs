//! The rate table: geometry, motion, servo and encoder.

mod encoder;
mod known_answers_turntable;
mod turntable_geometry;
mod turntable_profiles;
mod turntable_script;
mod turntable_servo;
