/** Which dialog about the file of the behavior is open. */
import { pageStore } from '../../api/pageStore'

export type FileDialog = 'versions' | 'rename' | 'duplicate' | 'delete'

export const useFileDialog = pageStore<{ readonly open: FileDialog | undefined }>(() => ({ open: undefined }))

export function openFileDialog(dialog: FileDialog): void {
  useFileDialog.setState({ open: dialog })
}

export function closeFileDialog(): void {
  useFileDialog.setState({ open: undefined })
}
