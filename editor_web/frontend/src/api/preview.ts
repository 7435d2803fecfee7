/** Which named entry the page wants to see in 3D before anything runs. */
import { pageStore } from './pageStore'

export interface Previewed {
  /** The field or list that wants it; one that is already shown tells when it changes. */
  readonly by: string
  readonly kind: string
  /** Empty while nothing is chosen. */
  readonly name: string
  /** The arm that is to go there; empty where nothing says which. */
  readonly arm: string
}

interface PreviewStore {
  readonly shown: Previewed | undefined
}

export const usePreview = pageStore<PreviewStore>(() => ({ shown: undefined }))

/** Show this entry in the place of the one before; undefined shows none. */
export function showPreview(shown: Previewed | undefined): void {
  usePreview.setState({ shown })
}
