/** The look of alerts where that of the kit is hard to read. */

/** The kit's titles have the colour of the alert, which is too faint on its own light ground. */
export const READABLE_TITLE = { title: { color: 'var(--text)' } }
