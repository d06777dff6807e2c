//! Serves the panel and relays between browsers and vthal
