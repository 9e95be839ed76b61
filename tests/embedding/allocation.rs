//! What the header says about memory.

use bricard_capi::{Handle, Status, Watch};
use bricard_embedding::engine_interface;
use std::ffi::c_int;
use std::ptr;

#[test]
fn nothing_is_allocated_but_by_create_and_clone() {
    // SAFETY: the table is there for this version, and the handle is what `create` gave.
    unsafe {
        let table = engine_interface(bricard_capi::ABI)
            .as_ref()
            .expect("it is there");
        let mut handle: *mut Handle = ptr::null_mut();
        assert_eq!((table.create)(&raw mut handle), Status::Ok);
        let mut copy: *mut Handle = ptr::null_mut();
        assert_eq!((table.clone)(handle, &raw mut copy), Status::Ok);
        let mut rows = [0.0; 700];
        let mut watch = Watch {
            size: size_of::<Watch>(),
            user: ptr::null_mut(),
            every: 0.1,
            columns: 15,
            inside: 0,
            rows: rows.as_mut_ptr(),
            room: rows.len(),
            take: None,
            event: None,
            passage: None,
            go_on: None,
            written: 0,
        };
        let mut numbers = [0.0; 9];
        let refused: c_int = 99;
        let used = allocation_counter::measure(|| {
            assert_eq!((table.set_parameter)(handle, 0, 0.6), Status::Ok);
            assert_eq!((table.set_start)(handle, 1, 0, 0.7, 0), Status::Ok);
            assert_eq!((table.assemble)(handle, 0.0), Status::Ok);
            let run = (table.run)(handle, 3.0, &raw mut watch, ptr::null_mut());
            assert_eq!(run, Status::Ok);
            assert_eq!((table.step)(handle, 0.1), Status::Ok);
            assert_eq!((table.assign)(copy, handle), Status::Ok);
            let mass = (table.evaluate)(handle, 0, ptr::null(), numbers.as_mut_ptr(), 9);
            assert_eq!(mass, Status::Ok);
            let mut count = 0;
            let status = (table.count)(handle, refused, &raw mut count);
            assert_eq!(status, Status::Argument);
        });
        assert_eq!(used.count_total, 0);
        assert_eq!(watch.written, 31);
        (table.free)(&raw mut copy);
        (table.free)(&raw mut handle);
    }
}
