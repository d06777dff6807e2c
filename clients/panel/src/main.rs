fn main() {
    leptos::mount::mount_to_body(|| leptos::view! { <p>"x"</p> });
    let _ = serde_json::to_string(&1);
}
