//! What objects need of a device's limits, checked before anything is made. A device may have been created with limits far below
//! WebGPU's defaults; what it then says of an object is no help to whoever chose a number of cascades.

/// A limit in its own unit, what of it is needed, and what the device has.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Need {
    pub limit: &'static str,
    pub needed: u64,
    pub maximum: u64,
}

impl Need {
    pub fn new(limit: &'static str, needed: impl Into<u64>, maximum: impl Into<u64>) -> Self {
        Self {
            limit,
            needed: needed.into(),
            maximum: maximum.into(),
        }
    }

    /// The first of `needs` that the device does not meet.
    pub fn first_unmet(needs: impl IntoIterator<Item = Self>) -> Option<Self> {
        needs.into_iter().find(|need| need.needed > need.maximum)
    }
}
