/** What was copied: in the clipboard of the browser, and on this page where the browser does not allow that. */
import { pageStore } from '../../api/pageStore'

const clipped = pageStore(() => ({ text: '' }))

export async function toClipboard(text: string): Promise<void> {
  clipped.setState({ text })
  try {
    await navigator.clipboard.writeText(text)
  } catch {
    // Not allowed to write: pasting on this page works all the same.
  }
}

/** Empty where nothing was copied. */
export async function fromClipboard(): Promise<string> {
  const { text } = clipped.getState()
  try {
    return (await navigator.clipboard.readText()) || text
  } catch {
    // Not allowed to read; what was copied on this page is known.
    return text
  }
}
