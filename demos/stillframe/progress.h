#pragma once
// A line on standard error that fills up, when that is a terminal and quiet is not asked for.

namespace still::command {

class ProgressBar {
  public:
    explicit ProgressBar(int total, bool quiet = false);
    ~ProgressBar();
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;

    /// `done` of the total are finished.
    void show(int done) const;
    /// Takes the line away; nothing may be printed to standard error before that.
    void clear() const;

  private:
    int total_;
    bool terminal_;
};

}  // namespace still::command
