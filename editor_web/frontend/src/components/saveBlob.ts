/** Saves a file that the page has made or fetched, as a download of the browser. */
export function saveBlob(blob: Blob, name: string): void {
  const link = document.createElement('a')
  link.href = URL.createObjectURL(blob)
  link.download = name
  link.click()
  // The browser has taken it when the click has been handled; a moment later nobody needs it.
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000)
}
