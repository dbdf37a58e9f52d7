// SPDX-License-Identifier: Apache-2.0
// The C interface from Rust, without generated bindings.
use std::ffi::{c_char, c_void, CStr};

#[repr(C)]
struct Points {
    x: *const c_void,
    y: *const c_void,
    count: usize,
    stride: usize,
    scalar: i32,
}

#[repr(C)]
struct Options {
    size: usize,
    backend: i32,
    order: i32,
    device: *const c_char,
    max_memory: u64,
    threads: u32,
    keep_points: i32,
    statistics: i32,
    has_queue: i32,
    queue: *mut c_void,
    strategy: i32,
    work_group_size: u32,
    user: *mut c_void,
    progress: Option<unsafe extern "C" fn(*const c_char, f64, *mut c_void)>,
    cancelled: Option<unsafe extern "C" fn(*mut c_void) -> i32>,
    allocate: Option<unsafe extern "C" fn(usize, *mut c_void, *mut c_void) -> *mut c_void>,
    deallocate: Option<unsafe extern "C" fn(*mut c_void, usize, *mut c_void, *mut c_void)>,
}

#[repr(C)]
struct Handle {
    _private: [u8; 0],
}

#[link(name = "cadt")]
extern "C" {
    fn cadt_last_error_message() -> *const c_char;
    fn cadt_options_init(options: *mut Options, size: usize) -> i32;
    fn cadt_triangulate(points: *const Points, options: *const Options, mesh: *mut *mut Handle) -> i32;
    fn cadt_triangulation_size(mesh: *const Handle, points: *mut usize, triangles: *mut usize) -> i32;
    fn cadt_triangulation_triangles(mesh: *const Handle, triangles: *mut *const i32) -> i32;
    fn cadt_triangulation_free(mesh: *mut Handle);
}

fn check(status: i32) -> Result<(), String> {
    if status == 0 {
        return Ok(());
    }
    Err(unsafe { CStr::from_ptr(cadt_last_error_message()) }.to_string_lossy().into_owned())
}

unsafe extern "C" fn count_calls(_phase: *const c_char, _fraction: f64, user: *mut c_void) {
    *(user as *mut u32) += 1;
}

fn triangulate(xy: &[[f64; 2]]) -> Result<(Vec<[i32; 3]>, u32), String> {
    unsafe {
        let mut options: Options = std::mem::zeroed();
        let mut calls = 0u32;
        check(cadt_options_init(&mut options, std::mem::size_of::<Options>()))?;
        options.backend = 1;
        options.progress = Some(count_calls);
        options.user = &mut calls as *mut u32 as *mut c_void;
        let points = Points { x: xy.as_ptr() as *const c_void, y: std::ptr::null(), count: xy.len(), stride: 0, scalar: 0 };
        let mut mesh = std::ptr::null_mut();
        check(cadt_triangulate(&points, &options, &mut mesh))?;
        let (mut n, mut count, mut first) = (0, 0, std::ptr::null());
        check(cadt_triangulation_size(mesh, &mut n, &mut count))?;
        check(cadt_triangulation_triangles(mesh, &mut first))?;
        let triangles = std::slice::from_raw_parts(first as *const [i32; 3], count).to_vec();
        cadt_triangulation_free(mesh);
        Ok((triangles, calls))
    }
}

fn main() {
    let (triangles, calls) = triangulate(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.5, 0.5]]).unwrap();
    assert_eq!(triangles, [[0, 1, 4], [0, 4, 3], [1, 2, 4], [2, 3, 4]]);
    assert!(calls > 0);
    let error = triangulate(&[[0.0, 0.0], [f64::NAN, 0.0]]).unwrap_err();
    assert!(error.contains("point 1"), "{}", error);
    println!("rust: ok");
}
