/** The search, loaded once the page is there: what is typed right after its key is not lost, and the page begins without it. */
import { useEffect, useState, type ComponentType } from 'react'
import { useSearch } from '../api/search'
import { WhileLoading, lazyView } from '../components/lazyView'
import { ViewBoundary } from '../components/ViewBoundary'
import type { SearchBoxProps } from '../features/search/SearchBox'

async function load(): Promise<ComponentType<SearchBoxProps>> {
  return (await import('../features/search/SearchBox')).SearchBox
}

const LazySearchBox = lazyView(load)

export function SearchPlace(props: SearchBoxProps) {
  const isOpen = useSearch((s) => s.isOpen)
  const [Loaded, setLoaded] = useState<ComponentType<SearchBoxProps>>()
  useEffect(() => {
    // A load that fails is tried again, and said, when the search is opened.
    load().then(
      (component) => setLoaded(() => component),
      () => undefined,
    )
  }, [])
  if (!isOpen) return null
  const Box = Loaded ?? LazySearchBox
  return (
    <ViewBoundary name="Search">
      <WhileLoading value={null}>
        <Box {...props} />
      </WhileLoading>
    </ViewBoundary>
  )
}
